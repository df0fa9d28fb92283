// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/stl.h"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto {
namespace {

const char* const kRemake = "make it anew with 'vielto geometry'";

// VTK takes a cut-off file for a shorter one: the end has to be there.
void refuse_cut_off(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path, 0, "cannot be read", kRemake);
  const auto size = std::filesystem::file_size(path);
  if (size == 0) throw BadInput(path, 0, "is empty", kRemake);
  std::string start(84, '\0');
  in.read(start.data(), 84);
  std::uint32_t count = 0;
  std::memcpy(&count, start.data() + 80, 4);
  const bool binary = in.gcount() == 84 && size == 84 + 50ull * count;
  if (binary) return;
  if (start.rfind("solid", 0) != 0) throw BadInput(path, 1, "is not an STL file, or cut off", kRemake);
  in.clear();
  in.seekg(0);
  std::string line, last;
  int number = 0;
  while (std::getline(in, line)) {
    ++number;
    // VTK would take the file for a binary one, and four letters of it for the number of triangles
    if (std::any_of(line.begin(), line.end(),
                    [](unsigned char c) { return !std::isprint(c) && c != '\t' && c != '\r'; }))
      throw BadInput(path, number, "begins as text, but holds bytes that are no text", kRemake);
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  if (last.find("endsolid") == std::string::npos) throw BadInput(path, number, "ends before 'endsolid'", kRemake);
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
  refuse_cut_off(path);
  std::string complaint;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&complaint);
  listen->SetCallback([](vtkObject*, unsigned long, void* text, void* message) {
    *static_cast<std::string*>(text) = static_cast<const char*>(message);
  });
  vtkNew<vtkSTLReader> reader;
  reader->AddObserver(vtkCommand::ErrorEvent, listen);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listen);  // it complains once more by itself
  reader->SetFileName(path.c_str());
  reader->Update();
  if (!complaint.empty()) throw BadInput(path, 0, "is a corrupt STL file", kRemake);
  vtkPolyData* data = reader->GetOutput();
  Triangles triangles;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    data->GetCellPoints(i, n, ids);
    Triangle t;
    for (int k = 0; k < 3; ++k) t[k] = Point(data->GetPoint(ids[k]));
    if (n != 3 || !((t[1] - t[0]).cross(t[2] - t[0]).norm() > 1e-16) || !t[0].allFinite() || !t[1].allFinite() ||
        !t[2].allFinite())
      throw BadInput(path, 0, fmt::format("triangle {} has no area", i + 1), kRemake);
    triangles.push_back(t);
  }
  if (triangles.empty()) throw BadInput(path, 0, "holds no triangle", kRemake);
  return triangles;
}

Measure check_stl(const std::string& path, bool closed) {
  const Measure m = measure(read_stl(path));
  if (closed && (m.open_edges > 0 || m.crowded_edges > 0))
    throw BadInput(path, 0,
                   fmt::format("is not closed: {} open edges, {} edges shared wrongly", m.open_edges, m.crowded_edges),
                   kRemake);
  return m;
}

}  // namespace vielto
