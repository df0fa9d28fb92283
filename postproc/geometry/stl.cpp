// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto {
namespace {

const char* const kExport = "export it again as STL";

bool has_binary_length(const std::string& start, std::uintmax_t size) {
  std::uint32_t count = 0;
  if (start.size() < 84) return false;
  std::memcpy(&count, start.data() + 80, 4);
  return size == 84 + 50ull * count;
}

std::string first_bytes(const std::string& path, std::size_t most) {
  std::string start(most, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(start.data(), static_cast<std::streamsize>(most));
  start.resize(static_cast<std::size_t>(in.gcount()));
  return start;
}

Triangles read_binary(const std::string& path) {
  Triangles triangles;
  std::ifstream in(path, std::ios::binary);
  in.seekg(84);
  char record[50];
  while (in.read(record, sizeof record)) {
    float numbers[12];
    std::memcpy(numbers, record, sizeof numbers);  // normal, then three vertices
    Triangle t;
    for (int k = 0; k < 3; ++k) t[k] = Point(numbers[3 * k + 3], numbers[3 * k + 4], numbers[3 * k + 5]);
    for (const Point& p : t)
      if (!p.allFinite())
        throw BadInput(path, 0, fmt::format("triangle {} has a vertex that is no number", triangles.size() + 1),
                       kExport);
    triangles.push_back(t);
  }
  return triangles;
}

// Words "vertex x y z" make triangles, three to a "facet"; "endsolid" ends the file or one of its solids.
Triangles read_text(const std::string& path) {
  std::ifstream in(path);
  Triangles triangles;
  Triangle t;
  int number = 0, corners = 0;
  bool ended = false;
  const auto refuse = [&](const std::string& what) {
    throw BadInput(path, number, in.eof() ? "ends before 'endsolid': the file is cut off" : what, kExport);
  };
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto unprintable = [](unsigned char c) { return c < 128 && !std::isprint(c) && !std::isspace(c); };
    if (std::any_of(line.begin(), line.end(), unprintable)) refuse("begins as text, but holds bytes that are no text");
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) continue;
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    if (word == "vertex") {
      double x[3];
      std::string rest;
      if (!(words >> x[0] >> x[1] >> x[2]) || words >> rest) refuse("is no vertex of three numbers");
      if (corners == 3) refuse("is a fourth vertex of one facet");
      t[corners++] = Point(x[0], x[1], x[2]);
    } else if (word == "endfacet") {
      if (corners != 3) refuse(fmt::format("ends a facet of {} vertices", corners));
      triangles.push_back(t);
      corners = 0;
    } else if (word != "solid" && word != "facet" && word != "outer" && word != "endloop" && word != "endsolid") {
      refuse(fmt::format("begins with '{}', which is no word of an STL file", word));
    }
    ended = word == "endsolid";
  }
  if (!ended) refuse("");
  return triangles;
}

}  // namespace

void write_stl(const std::string& path, const std::string& name, const Triangles& triangles) {
  std::string text = fmt::format("solid {}\n", name);
  for (const Triangle& t : triangles) {
    const Point n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    text += fmt::format("facet normal {:.9g} {:.9g} {:.9g}\n outer loop\n", n.x(), n.y(), n.z());
    for (const Point& p : t) text += fmt::format("  vertex {:.12g} {:.12g} {:.12g}\n", p.x(), p.y(), p.z());
    text += " endloop\nendfacet\n";
  }
  write_whole_file(path, text + fmt::format("endsolid {}\n", name));
}

Triangles read_stl(const std::string& path) {
  if (!std::ifstream(path) || std::filesystem::is_directory(path))
    throw BadInput(path, 0, "cannot be read", "check its name, and the folder that it starts from");
  const auto size = std::filesystem::file_size(path);
  if (size == 0) throw BadInput(path, 0, "is empty", kExport);
  const std::string start = first_bytes(path, 84);
  const auto first = std::min(start.find_first_not_of(" \t\r\n"), start.size());
  std::string word = start.substr(first, 5);
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  Triangles triangles;
  if (has_binary_length(start, size))
    triangles = read_binary(path);
  else if (word == "solid" && start.find('\0') == std::string::npos)
    triangles = read_text(path);
  else
    throw BadInput(path, 0, "is no STL file, or cut off: its length is not that of its number of triangles", kExport);
  if (triangles.empty()) throw BadInput(path, 0, "holds no triangle", kExport);
  return triangles;
}

StlCheck check_stl(const std::string& path, bool closed) {
  const Triangles triangles = read_stl(path);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (!((t[1] - t[0]).cross(t[2] - t[0]).norm() > 1e-16))
      throw BadInput(path, 0, fmt::format("triangle {} has no area", i + 1), kExport);
  }
  StlCheck check{measure(triangles), ""};
  const Measure& m = check.measure;
  if (closed && (m.open_edges > 0 || m.crowded_edges > 0))
    throw BadInput(path, 0,
                   fmt::format("is not closed: {} open edges, {} edges shared wrongly", m.open_edges, m.crowded_edges),
                   kExport);
  const std::string start = first_bytes(path, 84);
  const bool binary = has_binary_length(start, std::filesystem::file_size(path));
  if (binary && start.substr(0, 5) == "solid")
    check.fault = "is binary, but begins with 'solid', by which LIGGGHTS takes it for text and finds no triangle";
  if (!binary && start.substr(0, 5) != "solid")
    check.fault = "is text, but does not begin with 'solid', by which LIGGGHTS takes it for binary";
  return check;
}

}  // namespace vielto
