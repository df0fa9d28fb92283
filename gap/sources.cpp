// SPDX-License-Identifier: GPL-2.0-or-later
#include "sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "bad_input.h"
#include "columns.h"
#include "condition.h"

namespace vielto::gap {
namespace {

struct Sum {
  double n = 0, mean = 0, squares = 0;  // Welford
  void add(double x) {
    const double step = x - mean;
    mean += step / ++n;
    squares += step * (x - mean);
  }
  double sd() const { return n > 1 ? std::sqrt(squares / (n - 1)) : 0; }
};

}  // namespace

nlohmann::ordered_json sources_json(const Library& library, const std::vector<std::string>& effects) {
  using json = nlohmann::ordered_json;
  json result = json::array();
  const std::string path = (std::filesystem::path(library.folder) / "sources.csv").string();
  if (!std::filesystem::exists(path)) return result;
  std::map<std::string, const Observation*> row_of;
  std::map<std::string, const Run*> run_of;
  for (const LibraryValue& v : library.values)
    if (v.row.apparatus == "mixer") row_of[library.runs[v.run].test] = &v.row;
  for (const Run& r : library.runs) run_of[r.test] = &r;

  // condition -> source -> baseline, and -> effect -> strength -> source
  struct Place {
    const Observation* row = nullptr;
    std::map<std::string, Sum> baseline;
    Sum rotor;
    std::map<std::string, std::map<double, std::map<std::string, Sum>>> effects;
  };
  std::map<std::string, Place> places;
  std::map<std::string, double> rotor_of_run;
  read_columns(path, {"test", "source", "torque_Nm"}, [&](int number, const std::vector<std::string_view>& f) {
    const double torque = column_number(path, number, "torque_Nm", f[2]);
    const std::string test(f[0]), source(f[1]);
    const auto row = row_of.find(test);
    if (row == row_of.end())
      throw BadInput(path, number, fmt::format("'{}' is no mixer run of design.csv", test),
                     "collect the library again");
    Place& place = places[conditions_text(*row->second)];
    place.row = row->second;
    const Run& run = *run_of.at(test);
    if (run.baseline) {
      place.baseline[source].add(torque);
      if (source != "drum") rotor_of_run[test] += torque;
    } else if (run.effect != "none") {
      place.effects[run.effect][run.strength][source].add(torque);
    }
  });
  for (const auto& [test, torque] : rotor_of_run) places[conditions_text(*row_of.at(test))].rotor.add(torque);

  for (const auto& [name, place] : places) {
    if (!(place.rotor.mean > 0)) continue;
    const double rotor = place.rotor.mean;
    for (const auto& [source, baseline] : place.baseline) {
      json entry = {{"speed", place.row->speed ? json(*place.row->speed) : json()},
                    {"fill", place.row->fill ? json(*place.row->fill) : json()},
                    {"source", source},
                    {"share", baseline.mean / rotor},
                    {"u", baseline.sd() / std::sqrt(baseline.n) / rotor},
                    {"effects", json::array()}};
      for (const std::string& effect : effects) {
        const auto found = place.effects.find(effect);
        if (found == place.effects.end()) continue;
        const auto most =
            std::max_element(found->second.begin(), found->second.end(),
                             [](const auto& a, const auto& b) { return std::fabs(a.first) < std::fabs(b.first); });
        const auto with = most->second.find(source);
        if (with == most->second.end()) continue;
        entry["effects"].push_back({{"name", effect},
                                    {"strength", most->first},
                                    {"change", (with->second.mean - baseline.mean) / rotor},
                                    {"u", baseline.sd() * std::sqrt(1 / with->second.n + 1 / baseline.n) / rotor}});
      }
      result.push_back(entry);
    }
  }
  return result;
}

}  // namespace vielto::gap
