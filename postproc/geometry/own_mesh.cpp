// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/own_mesh.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core/bad_input.h"
#include "geometry/slivers.h"

namespace vielto {
namespace {

constexpr std::size_t kMostTimes = 20;  // triangles after the cutting of slivers, over those before

// Vertices within kMergeDistance are one: a lattice of that width, with the neighbouring cells looked at too.
Indexed merged(const Triangles& triangles) {
  Indexed mesh;
  std::map<std::array<long long, 3>, std::vector<int>> cells;
  const auto index_of = [&](const Point& p) {
    std::array<long long, 3> cell;
    for (int d = 0; d < 3; ++d) cell[d] = std::llround(p[d] / kMergeDistance);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto near = cells.find({cell[0] + x, cell[1] + y, cell[2] + z});
          if (near == cells.end()) continue;
          for (const int i : near->second)
            if ((mesh.points[i] - p).norm() <= kMergeDistance) return i;
        }
    mesh.points.push_back(p);
    const int index = static_cast<int>(mesh.points.size()) - 1;
    cells[cell].push_back(index);
    return index;
  };
  for (const Triangle& t : triangles) mesh.faces.push_back({index_of(t[0]), index_of(t[1]), index_of(t[2])});
  return mesh;
}

void drop(Indexed& mesh, const std::function<bool(const std::array<int, 3>&)>& which, const char* what,
          std::vector<std::string>& mended) {
  const std::size_t before = mesh.faces.size();
  mesh.faces.erase(std::remove_if(mesh.faces.begin(), mesh.faces.end(), which), mesh.faces.end());
  if (const std::size_t n = before - mesh.faces.size())
    mended.push_back(fmt::format("{} triangles {} dropped", n, what));
}

void drop_collapsed(Indexed& mesh, std::vector<std::string>& mended) {
  const auto collapsed = [](const auto& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; };
  drop(mesh, collapsed, "without area", mended);
}

void drop_doubles(Indexed& mesh, std::vector<std::string>& mended) {
  std::set<std::array<int, 3>> seen;
  const auto again = [&](std::array<int, 3> f) {
    std::sort(f.begin(), f.end());
    return !seen.insert(f).second;
  };
  drop(mesh, again, "that were there twice", mended);
}

// One orientation a shell, outward if it is closed.
void orient(Indexed& mesh, bool closed, std::vector<std::string>& mended) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Point& p : mesh.points) points->InsertNextPoint(p.data());
  vtkNew<vtkCellArray> cells;
  for (const auto& f : mesh.faces) {
    const vtkIdType ids[3] = {f[0], f[1], f[2]};
    cells->InsertNextCell(3, ids);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(data);
  normals->SplittingOff();
  normals->ConsistencyOn();
  normals->NonManifoldTraversalOff();
  normals->SetAutoOrientNormals(closed);
  normals->Update();
  vtkPolyData* out = normals->GetOutput();
  std::size_t turned = 0;
  for (vtkIdType i = 0; i < out->GetNumberOfCells(); ++i) {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    out->GetCellPoints(i, n, ids);
    auto& f = mesh.faces[static_cast<std::size_t>(i)];
    // the same corners, round the other way?
    const auto at = std::find(ids, ids + 3, f[0]) - ids;
    if (ids[(at + 1) % 3] == f[1]) continue;
    std::swap(f[1], f[2]);
    ++turned;
  }
  if (turned > 0) mended.push_back(fmt::format("{} triangles turned round", turned));
}

Triangles loose(const Indexed& mesh) {
  Triangles triangles;
  for (const auto& f : mesh.faces) triangles.push_back(mesh.triangle(f));
  return triangles;
}

std::string first_open_edge(const Indexed& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& f : mesh.faces)
    for (int i = 0; i < 3; ++i) ++uses[std::minmax(f[i], f[(i + 1) % 3])];
  for (const auto& [edge, count] : uses)
    if (count == 1) {
      const Point m = (mesh.points[edge.first] + mesh.points[edge.second]) / 2;
      return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", m.x(), m.y(), m.z());
    }
  return "";
}

}  // namespace

MendedMesh mended_mesh(const std::string& path, const Triangles& triangles) {
  if (triangles.size() > kMostTriangles)
    throw BadInput(path, 0, fmt::format("has {} triangles, over {}", triangles.size(), kMostTriangles),
                   "export it with a coarser tolerance");
  MendedMesh result;
  Indexed mesh = merged(triangles);
  drop_collapsed(mesh, result.mended);
  drop_doubles(mesh, result.mended);
  orient(mesh, measure(loose(mesh)).open_edges == 0, result.mended);
  const Measure oriented = measure(loose(mesh));
  if (oriented.smallest_angle < kLeastAngle && oriented.crowded_edges == 0) {
    const std::size_t before = mesh.faces.size();
    widen(mesh, kLeastAngle, kMergeDistance, std::min(kMostTriangles, kMostTimes * before + 1000));
    result.mended.push_back(fmt::format("slivers cut anew: {} triangles for {}", mesh.faces.size(), before));
  }
  const auto flat = [&](const auto& f) { return height(mesh.triangle(f)) <= kMergeDistance; };
  drop(mesh, flat, "without area", result.mended);
  if (mesh.faces.empty())
    throw BadInput(path, 0, "holds no triangle wider than 1e-6 m", "check its unit of length, or export it again");
  result.first_open_edge = first_open_edge(mesh);
  result.triangles = loose(mesh);
  result.measure = measure(result.triangles);
  for (const Triangle& t : result.triangles)
    if (smallest_angle(t) < kLeastTaken)
      throw BadInput(
          path, 0,
          fmt::format("has a triangle with an angle of {:.2g} deg at ({:.4g}, {:.4g}, {:.4g}) m, which LIGGGHTS "
                      "does not take",
                      smallest_angle(t) * 180 / kPi, t[0].x(), t[0].y(), t[0].z()),
          "export it with another tolerance, or from a body without such a narrow corner");
  return result;
}

}  // namespace vielto
