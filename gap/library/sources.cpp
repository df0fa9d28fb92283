// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <set>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/mixing_numbers.h"
#include "core/paddle_sectors.h"
#include "gap/library/columns.h"

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

constexpr const char* kDrum = "drum";  // the mixer's, which stands

// Torque of the paddles by sector, from phase_deg,paddle_Nm of phase.csv; empty for the whole drum, and for a machine
// whose parts have other names.
std::array<double, kSectors> sector_shares(const std::string& path) {
  std::string header;
  std::getline(std::ifstream(path), header);
  if (header.find(",paddle_Nm") == std::string::npos) return {};
  std::array<double, kSectors> sums{};
  double all = 0;
  bool whole_drum = false;
  read_columns(path, {"phase_deg", "paddle_Nm"}, [&](int number, const std::vector<std::string_view>& f) {
    if (f[1].empty()) {
      whole_drum = true;
      return;
    }
    const double torque = column_number(path, number, "paddle_Nm", f[1]);
    sums[sector_of(column_number(path, number, "phase_deg", f[0]))] += torque;
    all += torque;
  });
  if (whole_drum || all == 0) return {};
  for (double& sum : sums) sum /= all;
  return sums;
}

std::string sector_name(std::size_t sector) {
  return fmt::format("{:g} to {:g} deg", sector_begin(sector), sector_begin(sector) + kSectorWidth);
}

}  // namespace

void add_paddle_shares(Library& library) {
  const std::string path = (std::filesystem::path(library.folder) / "sources.csv").string();
  if (!std::filesystem::exists(path)) return;
  std::map<std::string, std::array<double, kSectors>> torques;
  read_columns(path, {"test", "kind", "source", "torque_Nm"}, [&](int number, const std::vector<std::string_view>& f) {
    for (std::size_t k = 0; f[1] == "phase" && k < kSectors; ++k)
      if (f[2] == sector_name(k)) torques[std::string(f[0])][k] = column_number(path, number, "torque_Nm", f[3]);
  });
  std::set<int> seen;
  std::vector<LibraryValue> shares;
  for (const LibraryValue& value : library.values) {
    const auto run = torques.find(value.row.test);
    if (value.row.apparatus != "mixer" || run == torques.end() || !seen.insert(value.run).second) continue;
    const double all = std::accumulate(run->second.begin(), run->second.end(), 0.0);
    if (!(all > 0)) continue;
    for (const PaddleShare& share : kPaddleShares) {
      const bool stated = std::any_of(library.values.begin(), library.values.end(), [&](const LibraryValue& v) {
        return v.run == value.run && v.row.observable == share.observable;
      });
      if (stated) continue;
      LibraryValue added = value;
      added.row.observable = share.observable;
      added.row.unit = "1";
      added.row.value = run->second[share.sector] / all;
      shares.push_back(added);
    }
  }
  library.values.insert(library.values.end(), shares.begin(), shares.end());
}

std::string sources_of_run(const std::string& test, const nlohmann::json& power, const std::string& phase_file) {
  std::string rows;
  const auto add = [&](const char* kind, const std::string& source, double torque) {
    rows += fmt::format("{},{},{},{:.6g}\n", test, kind, source, torque);
  };
  for (const auto& [part, torque] : power.at("parts").items()) {
    const bool drum = part == kDrum, turns = torque.value("turns", !drum);  // older results lack it
    add(turns || drum ? "part" : "standing", turns && drum ? "turning drum" : part,
        torque.at("torque_Nm").get<double>());
  }
  if (std::filesystem::exists(phase_file)) {
    const auto shares = sector_shares(phase_file);
    const bool any = std::any_of(shares.begin(), shares.end(), [](double share) { return share != 0; });
    for (std::size_t k = 0; any && k < kSectors; ++k)
      add("phase", sector_name(k), power.at("parts").at("paddles").at("torque_Nm").get<double>() * shares[k]);
  }
  if (power.contains("losses") && power["losses"].is_object())
    for (const auto& [loss, value] : power["losses"].items())
      add("loss", loss, value["power_W"].get<double>() / shaft_power(1, power["speed"].get<double>()));
  return rows;
}

nlohmann::ordered_json sources_json(const Library& library, const std::vector<std::string>& effects) {
  using json = nlohmann::ordered_json;
  json result = json::array();
  const std::string path = (std::filesystem::path(library.folder) / "sources.csv").string();
  if (!std::filesystem::exists(path)) return result;
  std::map<std::string, const Observation*> row_of;
  std::map<std::string, const Run*> run_of;
  for (const LibraryValue& v : library.values) row_of[library.runs[v.run].test] = &v.row;
  for (const Run& r : library.runs) run_of[r.test] = &r;

  // condition -> kind and source -> baseline, and -> effect -> strength -> source
  using Source = std::pair<std::string, std::string>;
  struct Place {
    const Observation* row = nullptr;
    std::map<Source, Sum> baseline;
    Sum rotor;
    std::map<std::string, std::map<double, std::map<Source, Sum>>> effects;
  };
  std::map<std::string, Place> places;
  const auto name_of = [](const Observation& row) { return row.apparatus + " " + conditions_text(row); };
  std::map<std::string, double> rotor_of_run;
  read_columns(path, {"test", "kind", "source", "torque_Nm"}, [&](int number, const std::vector<std::string_view>& f) {
    const double torque = column_number(path, number, "torque_Nm", f[3]);
    const std::string test(f[0]);
    const Source source(f[1], f[2]);
    const auto row = row_of.find(test);
    if (row == row_of.end())
      throw BadInput(path, number, fmt::format("'{}' is no run of design.csv", test), "collect the library again");
    Place& place = places[name_of(*row->second)];
    place.row = row->second;
    const Run& run = *run_of.at(test);
    if (run.baseline()) {
      place.baseline[source].add(torque);
      if (source.first == "part" && source.second != kDrum) rotor_of_run[test] += torque;
    } else if (run.effects.size() == 1 && run.nominal) {
      const auto& [effect, strength] = *run.effects.begin();
      place.effects[effect][strength][source].add(torque);
    }
  });
  for (const auto& [test, torque] : rotor_of_run) places[name_of(*row_of.at(test))].rotor.add(torque);

  for (const auto& [name, place] : places) {
    if (!(place.rotor.mean > 0)) continue;
    const double rotor = place.rotor.mean;
    for (const auto& [source, baseline] : place.baseline) {
      json entry = {{"speed", place.row->speed ? json(*place.row->speed) : json()},
                    {"fill", place.row->fill ? json(*place.row->fill) : json()},
                    {"kind", source.first},
                    {"source", source.second},
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
