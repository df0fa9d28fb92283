// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/vtk_spheres.h"

#include <fmt/format.h>
#include <vtkDataCompressor.h>
#include <vtkInputStream.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkZLibDataCompressor.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/bad_input.h"

namespace vielto {
namespace {

const char* const kWholeFile = "name a whole file that VTKRecorder wrote with 'spheres'";
constexpr std::uint64_t kMostCompression = 1032;  // of zlib, RFC 1951: 258 bytes by two bits
constexpr unsigned kDeepest = 16;                 // elements in one another; these files have six

// VTK's parser, which also tells what stands at the head of an array before memory is taken for it.
class Parser : public vtkXMLDataParser {
 public:
  static Parser* New();

  bool appended() const { return AppendedDataPosition > 0; }
  std::uint64_t word_size() const { return HeaderType == 64 ? 8 : 4; }

  // The first `count` words at the head of an array, each of word_size() bytes; fewer if the file ends before.
  std::vector<std::uint64_t> head(vtkXMLDataElement* array, bool inline_data, std::int64_t offset, std::size_t count) {
    vtkInputStream* const stream = inline_data ? InlineDataStream : AppendedDataStream;
    Stream->clear();
    if (inline_data)
      SeekInlineDataPosition(array);
    else
      Stream->seekg(AppendedDataPosition + offset);
    std::vector<unsigned char> bytes(count * word_size());
    stream->SetStream(Stream);
    stream->StartReading();
    bytes.resize(stream->Read(bytes.data(), bytes.size()));
    stream->EndReading();
    std::vector<std::uint64_t> words;
    for (std::size_t i = 0; i + word_size() <= bytes.size(); i += word_size()) {
      std::uint64_t word = 0;
      for (std::size_t k = 0; k < word_size(); ++k)
        word |= static_cast<std::uint64_t>(bytes[i + (ByteOrder == LittleEndian ? k : word_size() - 1 - k)]) << 8 * k;
      words.push_back(word);
    }
    return words;
  }

 protected:
  void StartElement(const char* name, const char** attributes) override {
    if (++depth_ <= kDeepest) vtkXMLDataParser::StartElement(name, attributes);
  }
  void EndElement(const char* name) override {
    if (depth_-- <= kDeepest) vtkXMLDataParser::EndElement(name);
  }

 private:
  unsigned depth_ = 0;
};

vtkStandardNewMacro(Parser);

class SpheresFile {
 public:
  SpheresFile(const std::string& path, const std::string& kind)
      : path_(path), bytes_(std::filesystem::file_size(path)), in_(path, std::ios::binary) {
    vtkObject::GlobalWarningDisplayOff();  // VTK would print its own words about a broken file
    parser_->SetStream(&in_);
    const bool parsed = parser_->Parse() != 0;
    root_ = parser_->GetRootElement();
    if (!parsed || !root_ || text(root_, "type") != kind)
      throw BadInput(path_, 0, "is no VTK file of its kind", "name a file that VTKRecorder wrote with 'spheres'");
    set_compressor(text(root_, "compressor"));
  }

  std::vector<Grain> grains(const std::string& kind) {
    std::vector<Grain> all;
    vtkXMLDataElement* const data = root_->FindNestedElementWithName(kind.c_str());
    for (int i = 0; data && i < data->GetNumberOfNestedElements(); ++i)
      if (vtkXMLDataElement* const piece = data->GetNestedElement(i); piece->GetName() == std::string("Piece"))
        add_piece(piece, all);
    if (all.empty()) throw BadInput(path_, 0, "holds no grains that can be read", kWholeFile);
    return all;
  }

 private:
  static std::string text(vtkXMLDataElement* element, const char* attribute) {
    const char* const value = element->GetAttribute(attribute);
    return value ? value : "";
  }

  [[noreturn]] void refuse(const std::string& what) const { throw BadInput(path_, 0, what, kWholeFile); }

  void set_compressor(const std::string& name) {
    vtkSmartPointer<vtkDataCompressor> compressor;
    if (name.empty()) return;
    if (name == "vtkZLibDataCompressor")
      compressor = vtkSmartPointer<vtkZLibDataCompressor>::New();
    else if (name == "vtkLZ4DataCompressor")
      compressor = vtkSmartPointer<vtkLZ4DataCompressor>::New();
    else if (name == "vtkLZMADataCompressor")
      compressor = vtkSmartPointer<vtkLZMADataCompressor>::New();
    else
      throw BadInput(path_, 0, "has a compressor that is unknown here", "save it with zlib, or without compression");
    parser_->SetCompressor(compressor);
  }

  void add_piece(vtkXMLDataElement* piece, std::vector<Grain>& all) {
    int count = 0;
    if (!piece->GetScalarAttribute("NumberOfPoints", count) || count < 0) refuse("has no number of points");
    if (count == 0) return;
    vtkXMLDataElement* const points = piece->FindNestedElementWithName("Points");
    vtkXMLDataElement* const places = points ? array_of(points, "") : nullptr;
    if (!places) refuse("holds no points");
    vtkXMLDataElement* const at_points = piece->FindNestedElementWithName("PointData");
    vtkXMLDataElement* radii = at_points ? array_of(at_points, "radii") : nullptr;
    if (!radii && at_points) radii = array_of(at_points, "radius");
    if (!radii)
      throw BadInput(path_, 0, "has no array 'radii' at its points",
                     "name the file of the spheres (NAME-spheres.STEP.vtu)");
    const std::vector<double> x = numbers(places, static_cast<std::size_t>(count), 3);
    const std::vector<double> r = numbers(radii, static_cast<std::size_t>(count), 1);
    for (std::size_t i = 0; i < r.size(); ++i) all.push_back({{x[3 * i], x[3 * i + 1], x[3 * i + 2]}, r[i]});
  }

  // The first array of this name, or of any.
  static vtkXMLDataElement* array_of(vtkXMLDataElement* parent, const std::string& name) {
    for (int i = 0; i < parent->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* const array = parent->GetNestedElement(i);
      if (array->GetName() == std::string("DataArray") && (name.empty() || text(array, "Name") == name)) return array;
    }
    return nullptr;
  }

  std::vector<double> numbers(vtkXMLDataElement* array, std::size_t count, int components) {
    const std::string type = text(array, "type"), format = text(array, "format");
    int there = 1;
    array->GetScalarAttribute("NumberOfComponents", there);
    if (there != components || (type != "Float32" && type != "Float64"))
      refuse(fmt::format("has an array of other numbers than {} of Float32 or Float64 at a point", components));
    const std::size_t wanted = count * static_cast<std::size_t>(components);
    return type == "Float32" ? read<float>(array, format, wanted, VTK_FLOAT)
                             : read<double>(array, format, wanted, VTK_DOUBLE);
  }

  template <class Number>
  std::vector<double> read(vtkXMLDataElement* array, const std::string& format, std::size_t wanted, int type) {
    std::int64_t offset = 0;
    if (format == "appended") {
      vtkTypeInt64 stated = 0;
      if (!parser_->appended() || !array->GetScalarAttribute("offset", stated) || stated < 0 ||
          static_cast<std::uint64_t>(stated) >= bytes_)
        refuse("has an array that is not in it");
      offset = stated;
    } else if (format != "binary" && format != "ascii") {
      refuse("has an array of a format that is unknown here");
    }
    check_size(array, format, offset, wanted, sizeof(Number));
    std::vector<Number> raw(wanted);
    in_.clear();
    const std::size_t got = format == "appended"
                                ? parser_->ReadAppendedData(offset, raw.data(), 0, wanted, type)
                                : parser_->ReadInlineData(array, format == "ascii", raw.data(), 0, wanted, type);
    if (got != wanted) refuse("holds less than its number of points says");
    return {raw.begin(), raw.end()};
  }

  // Before memory is taken: what the array's head says of its sizes, against what is wanted and the file's length.
  void check_size(vtkXMLDataElement* array, const std::string& format, std::int64_t offset, std::size_t wanted,
                  std::size_t size) {
    const bool compressed = parser_->GetCompressor() && format != "ascii";
    const std::uint64_t least = format == "ascii" ? 2 : size;  // bytes of a number: a digit and a blank
    if (wanted > (compressed ? kMostCompression : 1) * bytes_ / least + 1)
      refuse(fmt::format("has {} bytes, but says that it holds {} numbers of one kind", bytes_, wanted));
    if (format == "ascii") return;
    const std::uint64_t whole = wanted * size;
    const std::vector<std::uint64_t> head = parser_->head(array, format == "binary", offset, compressed ? 3 : 1);
    const char* const contradicts = "is cut off, or its sizes contradict one another";
    if (!compressed) {
      if (head.size() != 1 || head[0] != whole) refuse(contradicts);
      return;
    }
    // numbers of blocks, of bytes in a block, in the last one if that is shorter; then the blocks' compressed sizes
    if (head.size() != 3 || head[0] == 0 || head[0] > bytes_ / parser_->word_size() || head[1] == 0)
      refuse(contradicts);
    const std::uint64_t full = head[0] - (head[2] > 0 ? 1 : 0);
    if (head[2] > head[1] || (full > 0 && (head[1] > whole || head[1] % size != 0)) ||
        full * head[1] + head[2] != whole)
      refuse(contradicts);
    const std::vector<std::uint64_t> all = parser_->head(array, format == "binary", offset, 3 + head[0]);
    if (all.size() != 3 + head[0]) refuse(contradicts);
    for (std::size_t i = 3; i < all.size(); ++i)
      if (all[i] > bytes_) refuse(contradicts);
  }

  std::string path_;
  std::uint64_t bytes_;
  std::ifstream in_;
  vtkNew<Parser> parser_;
  vtkXMLDataElement* root_ = nullptr;
};

}  // namespace

std::vector<Grain> read_vtk_spheres(const std::string& path, const std::string& kind) {
  return SpheresFile(path, kind).grains(kind);
}

}  // namespace vielto
