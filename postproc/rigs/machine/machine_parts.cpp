// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/machine/machine_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "core/bad_input.h"
#include "core/toml_table.h"
#include "geometry/stl.h"

namespace vielto {
namespace {

constexpr double kSmallest = 0.005, kLargest = 10;  // m, of a whole machine

Point three(const TomlTable& table, const std::string& key) {
  const toml::array* list = table.raw()[key].as_array();
  Point p;
  if (!list || list->size() != 3) table.refuse(key, "is not three numbers", "write [0, 0, 1]");
  for (std::size_t d = 0; d < 3; ++d) {
    const auto value = (*list)[d].is_number() ? (*list)[d].value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) table.refuse(key, "is not three numbers", "write [0, 0, 1]");
    p[static_cast<Eigen::Index>(d)] = *value;
  }
  return p;
}

bool yes(const TomlTable& table, const std::string& key) {
  if (!table.has(key)) return false;
  const auto value = table.raw()[key].value<bool>();
  if (!value) table.refuse(key, "is neither true nor false", "write true or false, without quotes");
  return *value;
}

double unit_of(const TomlTable& table) {
  const std::map<std::string, double> units = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"in", 0.0254}};
  const auto found = units.find(table.text("unit"));
  if (found == units.end()) table.refuse("unit", "is no unit of length here", "write m, mm, cm or in");
  return found->second;
}

// From the files' coordinates to the frame of the run.
struct Frame {
  double unit = 1;
  Point origin;
  Eigen::Matrix3d rows;  // x, y, z of the run

  Point operator()(const Point& p) const { return rows * (unit * (p - origin)); }
};

Frame frame_of(const TomlTable& machine, TurnAxis& axis) {
  Frame frame;
  frame.unit = unit_of(machine);
  const TomlTable stated = machine.table("axis");
  stated.only({"origin", "direction"});
  frame.origin = three(stated, "origin");
  const Point direction = three(stated, "direction"), up = three(machine, "up");
  if (!(direction.norm() > 0)) stated.refuse("direction", "has no length", "write [1, 0, 0]");
  if (!(up.norm() > 0)) machine.refuse("up", "has no length", "write [0, 0, 1]");
  const Point z = up.normalized(), along = direction.normalized();
  Point x = along - along.dot(z) * z;
  for (const Point& other : {Point(Point::UnitX()), Point(Point::UnitY())})
    if (x.norm() < 1e-9) x = other - other.dot(z) * z;  // an upright axis
  x.normalize();
  frame.rows << x.transpose(), z.cross(x).transpose(), z.transpose();
  axis = {Point::Zero(), frame.rows * along};
  for (double& a : axis.direction)
    if (std::fabs(a) < 1e-12) a = 0;
  return frame;
}

MachinePart read_part(const TomlTable& stated, const std::filesystem::path& folder, const Frame& frame) {
  stated.only({"name", "file", "motion", "open", "through"});
  MachinePart part;
  part.name = stated.text("name");
  // these begin names of columns that a record or a table has already
  const std::set<std::string> taken = {"gravity", "idle", "rotor", "paddle"};
  if (!std::regex_match(part.name, std::regex("[A-Za-z][A-Za-z0-9_]{0,30}")) || taken.count(part.name))
    stated.refuse("name", fmt::format("'{}' is no name of a part", part.name),
                  "write a word of a-z, A-Z, 0-9 and _ that begins with a letter and is not gravity, idle, rotor or "
                  "paddle");
  const std::string motion = stated.text("motion");
  if (motion != "turns" && motion != "stands") stated.refuse("motion", "is unknown", "write turns or stands");
  part.turns = motion == "turns";
  part.open = yes(stated, "open");
  part.through = yes(stated, "through");
  if (part.through && !part.turns) stated.refuse("through", "is for a part that turns", "leave it out");
  part.file = (folder / stated.text("file")).string();
  part.mesh.triangles = read_stl(part.file);
  for (Triangle& t : part.mesh.triangles)
    for (Point& p : t) p = frame(p);
  return part;
}

void mend(MachinePart& part) {
  part.mesh = mended_mesh(part.file, part.mesh.triangles);
  const Measure& m = part.mesh.measure;
  if (m.crowded_edges > 0)
    throw BadInput(part.file, 0, fmt::format("has {} edges that more than two triangles share", m.crowded_edges),
                   "give bodies that touch along an edge as parts of their own, or join them in CAD");
  if (m.open_edges > 0 && !part.open)
    throw BadInput(part.file, 0,
                   fmt::format("is not closed: {} edges have one triangle only, one of them at {}", m.open_edges,
                               part.mesh.first_open_edge),
                   fmt::format("close it in CAD, or write open = true for part {} if that is meant (a sheet, a vessel "
                               "without lid)",
                               part.name));
}

void check_extents(const MachineParts& machine, const TomlTable& table) {
  Point low = Point::Constant(INFINITY), high = -low;
  for (const MachinePart& part : machine.parts)
    for (const Triangle& t : part.mesh.triangles)
      for (const Point& p : t) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double size = (high - low).maxCoeff();
  if (size < kSmallest || size > kLargest)
    table.refuse("unit", fmt::format("is '{}', with which the machine is {:.4g} m long", table.text("unit"), size),
                 fmt::format("write the unit of the STL files; a machine of {} to {} m is taken", kSmallest, kLargest));
}

}  // namespace

Triangles MachineParts::of(bool turning, bool with_through) const {
  Triangles all;
  for (const MachinePart& part : parts)
    if (part.turns == turning && (with_through || !part.through))
      all.insert(all.end(), part.mesh.triangles.begin(), part.mesh.triangles.end());
  return all;
}

MachineParts read_machine_parts(const std::string& path) {
  const TomlTable table = TomlTable::read(path);
  table.only({"unit", "up", "axis", "part"});
  MachineParts machine;
  machine.path = path;
  const Frame frame = frame_of(table, machine.axis);
  const toml::array* list = table.raw()["part"].as_array();
  if (!list || list->empty() || !list->is_array_of_tables())
    table.refuse("part", "is missing", "describe each part under [[part]]");
  for (const toml::node& node : *list) {
    const TomlTable stated(path, *node.as_table());
    machine.parts.push_back(read_part(stated, std::filesystem::path(path).parent_path(), frame));
    for (std::size_t i = 0; i + 1 < machine.parts.size(); ++i)
      if (machine.parts[i].name == machine.parts.back().name)
        table.refuse("part", fmt::format("has the name '{}' twice", machine.parts[i].name), "name each part apart");
  }
  for (const bool turning : {true, false})
    if (machine.of(turning).empty())
      table.refuse("part", fmt::format("has none that {}", turning ? "turns" : "stands"),
                   fmt::format("write motion = \"{}\" for one", turning ? "turns" : "stands"));
  check_extents(machine, table);
  for (MachinePart& part : machine.parts) mend(part);
  return machine;
}

}  // namespace vielto
