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
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "core/bad_input.h"

namespace vielto {
namespace {

const char* const kExport = "export it again as STL";

Triangles read_binary(const std::string& path, std::ifstream& in, std::uint32_t count) {
  Triangles triangles;
  in.seekg(84);
  for (std::uint32_t i = 0; i < count; ++i) {
    char record[50];
    if (!in.read(record, sizeof record)) throw BadInput(path, 0, "cannot be read to its end", kExport);
    float numbers[12];
    std::memcpy(numbers, record, sizeof numbers);  // normal, then three vertices
    Triangle t;
    for (int k = 0; k < 3; ++k) t[k] = Point(numbers[3 * k + 3], numbers[3 * k + 4], numbers[3 * k + 5]);
    for (const Point& p : t)
      if (!p.allFinite())
        throw BadInput(path, 0, fmt::format("triangle {} has a vertex that is no number", i + 1), kExport);
    triangles.push_back(t);
  }
  return triangles;
}

// Words "vertex x y z" make triangles, three to a "facet"; "endsolid" ends the file or one of its solids.
Triangles read_text(const std::string& path, std::ifstream& in) {
  Triangles triangles;
  Triangle t;
  int number = 0, corners = 0;
  bool ended = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) continue;
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    if (word == "vertex") {
      double x[3];
      std::string rest;
      if (!(words >> x[0] >> x[1] >> x[2]) || words >> rest)
        throw BadInput(path, number, "is no vertex of three numbers", kExport);
      if (corners == 3) throw BadInput(path, number, "is a fourth vertex of one facet", kExport);
      t[corners++] = Point(x[0], x[1], x[2]);
    } else if (word == "endfacet") {
      if (corners != 3) throw BadInput(path, number, fmt::format("ends a facet of {} vertices", corners), kExport);
      triangles.push_back(t);
      corners = 0;
    } else if (word != "solid" && word != "facet" && word != "outer" && word != "endloop" && word != "endsolid") {
      throw BadInput(path, number, fmt::format("begins with '{}', which is no word of an STL file", word), kExport);
    }
    ended = word == "endsolid";
  }
  if (!ended) throw BadInput(path, number, "ends before 'endsolid': the file is cut off", kExport);
  return triangles;
}

// Indexed triangles, so that neighbours are known.
struct Indexed {
  std::vector<Point> points;
  std::vector<std::array<int, 3>> faces;

  Triangle triangle(const std::array<int, 3>& f) const { return {points[f[0]], points[f[1]], points[f[2]]}; }
};

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

double height(const Triangle& t) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, (t[(i + 1) % 3] - t[i]).norm());
  return longest > 0 ? (t[1] - t[0]).cross(t[2] - t[0]).norm() / longest : 0;
}

void drop_degenerate(Indexed& mesh, std::vector<std::string>& mended) {
  const std::size_t before = mesh.faces.size();
  const auto flat = [&](const std::array<int, 3>& f) {
    return f[0] == f[1] || f[1] == f[2] || f[2] == f[0] || height(mesh.triangle(f)) <= kMergeDistance;
  };
  mesh.faces.erase(std::remove_if(mesh.faces.begin(), mesh.faces.end(), flat), mesh.faces.end());
  if (const std::size_t n = before - mesh.faces.size())
    mended.push_back(fmt::format("{} triangles without area dropped", n));
  std::set<std::array<int, 3>> seen;
  const std::size_t once = mesh.faces.size();
  const auto again = [&](std::array<int, 3> f) {
    std::sort(f.begin(), f.end());
    return !seen.insert(f).second;
  };
  mesh.faces.erase(std::remove_if(mesh.faces.begin(), mesh.faces.end(), again), mesh.faces.end());
  if (const std::size_t n = once - mesh.faces.size())
    mended.push_back(fmt::format("{} triangles that were there twice dropped", n));
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

double smallest_angle(const Triangle& t) {
  double least = kPi;
  for (int i = 0; i < 3; ++i) {
    const Point u = t[(i + 1) % 3] - t[i], v = t[(i + 2) % 3] - t[i];
    least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
  }
  return least;
}

/* Slivers as CAD programs make them: a long strip in two triangles. An angle at a corner cannot be made greater, so
   that a sliver is joined with the triangle of its plane beyond its longest edge, the long edges of both get points
   between their ends, which their other neighbours get too, and every face so changed is cut into triangles anew. */
class SliverCut {
 public:
  explicit SliverCut(const Indexed& mesh) : points_(mesh.points) {
    for (const auto& f : mesh.faces) faces_.emplace_back(f.begin(), f.end());
    join_slivers();
    divide_edges();
  }
  Triangles triangles() {
    Triangles all;
    for (const std::vector<int>& face : faces_) {
      Face polygon;
      for (std::size_t i = 0; i < face.size(); ++i) {
        const int a = face[i], b = face[(i + 1) % face.size()];
        polygon.push_back(points_[a]);
        const auto parts = parts_.find(std::minmax(a, b));
        if (parts == parts_.end()) continue;
        const Point &low = points_[std::min(a, b)], &high = points_[std::max(a, b)];
        for (int k = 1; k < parts->second; ++k) {
          const int step = a < b ? k : parts->second - k;
          polygon.push_back(low + static_cast<double>(step) / parts->second * (high - low));
        }
      }
      const Triangles cut = triangulate({polygon});
      all.insert(all.end(), cut.begin(), cut.end());
    }
    return all;
  }

 private:
  using Edge = std::pair<int, int>;

  static Edge longest_edge(const std::vector<int>& face, const std::vector<Point>& points) {
    Edge longest(face[0], face[1]);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Edge edge(face[i], face[(i + 1) % face.size()]);
      if ((points[edge.second] - points[edge.first]).norm() > (points[longest.second] - points[longest.first]).norm())
        longest = edge;
    }
    return longest;
  }
  Point twice_area(const std::vector<int>& face) const {
    Point sum = Point::Zero();
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
      sum += (points_[face[i]] - points_[face[0]]).cross(points_[face[i + 1]] - points_[face[0]]);
    return sum;
  }
  bool slim(const std::vector<int>& face) const {
    if (face.size() == 3) return smallest_angle({points_[face[0]], points_[face[1]], points_[face[2]]}) < kLeastAngle;
    Face polygon;
    for (const int i : face) polygon.push_back(points_[i]);
    for (const Triangle& t : triangulate({polygon}))
      if (smallest_angle(t) < kLeastAngle) return true;
    return false;
  }
  // Four corners of two triangles that share an edge, if they lie in one plane and the four sides turn one way.
  std::vector<int> joined(const std::vector<int>& a, const std::vector<int>& b) const {
    std::vector<int> quad;
    for (int i = 0; i < 3; ++i) {
      quad.push_back(a[i]);
      const auto at = std::find(b.begin(), b.end(), a[i]);
      if (at == b.end() || b[(at - b.begin() + 2) % 3] != a[(i + 1) % 3]) continue;
      quad.push_back(b[(at - b.begin() + 1) % 3]);
    }
    if (quad.size() != 4) return {};
    const Point normal = twice_area(quad).normalized();
    for (std::size_t i = 0; i < 4; ++i) {
      const Point &p = points_[quad[i]], &q = points_[quad[(i + 1) % 4]], &r = points_[quad[(i + 2) % 4]];
      const Point turn = (q - p).cross(r - q);
      if (!(turn.dot(normal) > 0) || std::fabs((r - p).dot(normal)) > kMergeDistance) return {};
    }
    return quad;
  }
  void join_slivers() {
    std::map<Edge, std::vector<std::size_t>> users;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (int i = 0; i < 3; ++i) users[std::minmax(faces_[f][i], faces_[f][(i + 1) % 3])].push_back(f);
    std::vector<char> taken(faces_.size(), 0);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (taken[f] || !slim(faces_[f])) continue;
      const Edge edge = longest_edge(faces_[f], points_);
      for (const std::size_t other : users[std::minmax(edge.first, edge.second)]) {
        if (other == f || taken[other] || faces_[other].size() != 3) continue;
        const std::vector<int> quad = joined(faces_[f], faces_[other]);
        if (quad.empty()) continue;
        faces_[f] = quad;
        faces_[other].clear();
        taken[f] = taken[other] = 1;
        break;
      }
    }
    faces_.erase(std::remove_if(faces_.begin(), faces_.end(), [](const auto& f) { return f.empty(); }), faces_.end());
  }
  void divide_edges() {
    constexpr double kPart = 30;  // of an edge, over the width of the face: angles of 2 degrees
    for (const std::vector<int>& face : faces_) {
      if (!slim(face)) continue;
      const Edge longest = longest_edge(face, points_);
      const double width = 0.5 * twice_area(face).norm() / (points_[longest.second] - points_[longest.first]).norm();
      for (std::size_t i = 0; i < face.size(); ++i) {
        const int a = face[i], b = face[(i + 1) % face.size()];
        const double parts = std::ceil((points_[b] - points_[a]).norm() / (kPart * width));
        if (parts > 1)
          parts_[std::minmax(a, b)] =
              std::max(parts_[std::minmax(a, b)], static_cast<int>(std::min(parts, kMostParts)));
      }
    }
  }
  static constexpr double kMostParts = 200;  // cutting a face takes the third power of its corners

  std::vector<Point> points_;
  std::vector<std::vector<int>> faces_;
  std::map<Edge, int> parts_;  // of edges that are divided
};

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

Triangles read_own_stl(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path))
    throw BadInput(path, 0, "cannot be read", "name an STL file, from the folder of the file that names it");
  const auto size = std::filesystem::file_size(path);
  if (size == 0) throw BadInput(path, 0, "is empty", kExport);
  std::string start(84, '\0');
  in.read(start.data(), 84);
  std::uint32_t count = 0;
  std::memcpy(&count, start.data() + 80, 4);
  const bool whole_head = in.gcount() == 84;
  start.resize(static_cast<std::size_t>(in.gcount()));
  in.clear();
  Triangles triangles;
  if (whole_head && size == 84 + 50ull * count) {
    triangles = read_binary(path, in, count);
  } else {
    const auto first = start.find_first_not_of(" \t\r\n");
    std::string word = first == std::string::npos ? "" : start.substr(first, 5);
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool text = word == "solid" && start.find('\0') == std::string::npos;
    if (!text && whole_head && size > 84)
      throw BadInput(
          path, 0,
          fmt::format("is no STL file, or cut off: as a binary one its {} triangles take {} bytes, it has {}", count,
                      84 + 50ull * count, size),
          kExport);
    if (!text) throw BadInput(path, 0, "is no STL file", kExport);
    in.seekg(0);
    triangles = read_text(path, in);
  }
  if (triangles.empty()) throw BadInput(path, 0, "holds no triangle", kExport);
  return triangles;
}

MendedMesh mended_mesh(const std::string& path, const Triangles& triangles) {
  if (triangles.size() > kMostTriangles)
    throw BadInput(path, 0, fmt::format("has {} triangles, over {}", triangles.size(), kMostTriangles),
                   "export it with a coarser tolerance");
  MendedMesh result;
  Indexed mesh = merged(triangles);
  drop_degenerate(mesh, result.mended);
  if (mesh.faces.empty())
    throw BadInput(path, 0, "holds no triangle wider than 1e-6 m", "check its unit of length, or export it again");
  const Measure raw = measure(loose(mesh));
  orient(mesh, raw.open_edges == 0, result.mended);
  result.triangles = loose(mesh);
  result.first_open_edge = first_open_edge(mesh);
  if (measure(result.triangles).smallest_angle < kLeastAngle) {
    result.triangles = SliverCut(mesh).triangles();
    result.mended.push_back(
        fmt::format("slivers cut anew: {} triangles for {}", result.triangles.size(), mesh.faces.size()));
  }
  result.measure = measure(result.triangles);
  for (const Triangle& t : result.triangles)
    if (smallest_angle(t) < kLeastTaken)
      throw BadInput(
          path, 0,
          fmt::format("has a triangle with an angle of {:.2g} deg at ({:.4g}, {:.4g}, {:.4g}) m, which LIGGGHTS "
                      "does not take",
                      smallest_angle(t) * 180 / kPi, t[0].x(), t[0].y(), t[0].z()),
          "export it with another tolerance, or from a body without such a narrow face");
  return result;
}

}  // namespace vielto
