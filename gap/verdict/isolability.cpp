// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/isolability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bad_input.h"
#include "gap/verdict/evidence.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRivalStep = 2;  // of the strengths of a response

// Every `step`-th strength of the response but 0, and its ends.
std::vector<double> probe_strengths(const EffectResponse& e, Index step) {
  std::vector<double> s;
  for (Index k = 0; k < e.strengths.size(); k += step)
    if (e.strengths[k] != 0) s.push_back(e.strengths[k]);
  if (e.high > 0 && s.back() != e.high) s.push_back(e.high);
  return s;
}

// An effect at one strength.
struct Probe {
  double strength = 0;
  VectorXd response;
  MatrixXd covariance,
      uncertain;  // all that is uncertain with it; what the effect itself adds
};

std::vector<Probe> probes_of(const TableModel& model, const EffectResponse& e) {
  std::vector<Probe> probes;
  for (const double s : probe_strengths(e, kRivalStep))
    probes.push_back({s, e.response(s), covariance_at(model, {&e}, {s}), model.uncertain(e, s)});
  return probes;
}

// A shape error cannot make an effect vanish.
MatrixXd without_shape_error(const EffectResponse& e, const Probe& p) {
  return p.covariance - p.uncertain + e.emulator(p.strength);
}

double distance_from(const TableModel& model, const VectorXd& response, const MatrixXd& covariance,
                     const std::vector<Probe>& rival) {
  double least = chi_squared(response, covariance, model);  // the rival at 0
  for (const Probe& p : rival)
    least = std::min(least, chi_squared(response - p.response, covariance + p.uncertain, model));
  return std::sqrt(least);
}

std::size_t index_of(const Isolability& i, const std::string& effect) {
  return static_cast<std::size_t>(std::find(i.effects.begin(), i.effects.end(), effect) - i.effects.begin());
}

// The strength nearest to 0 from which on `holds` is true up to the farthest
// one, on its side of 0.
template <class Holds>
double first_strength(const Isolability& i, const std::string& effect, Holds holds) {
  const double end = i.farthest(effect);
  double first = std::numeric_limits<double>::quiet_NaN();
  constexpr int kSteps = 200;
  for (int k = kSteps; k > 0; --k) {
    const double s = end * k / kSteps;
    if (!holds(s)) break;
    first = s;
  }
  return first;
}

}  // namespace

double StrengthTable::at(double strength, const std::vector<double>& distances) const {
  const auto above = std::upper_bound(strengths.begin(), strengths.end(), strength) - strengths.begin();
  if (above == 0) return distances.front();
  if (above == static_cast<std::ptrdiff_t>(strengths.size())) return distances.back();
  const std::size_t i = static_cast<std::size_t>(above);
  const double part = (strength - strengths[i - 1]) / (strengths[i] - strengths[i - 1]);
  return (1 - part) * distances[i - 1] + part * distances[i];
}

double distance(const TableModel& model, const EffectResponse& a, double s, const EffectResponse& b) {
  return distance_from(model, a.response(s), covariance_at(model, {&a}, {s}), probes_of(model, b));
}

Isolability isolability(const TableModel& model, const Settings& settings) {
  Isolability result;
  result.group_distance = settings.group_distance;
  result.detectable_distance = settings.detectable_distance;
  std::vector<std::vector<Probe>> probes;
  for (const EffectResponse& e : model.effects) {
    result.effects.push_back(e.name);
    probes.push_back(probes_of(model, e));
  }
  for (std::size_t a = 0; a < probes.size(); ++a) {
    StrengthTable table;
    table.from_rival.resize(probes.size());
    const auto add = [&](double s, double from_nothing, const std::vector<double>& from_rival) {
      table.strengths.push_back(s);
      table.from_nothing.push_back(from_nothing);
      for (std::size_t b = 0; b < probes.size(); ++b)
        if (b != a) table.from_rival[b].push_back(from_rival[b]);
    };
    const std::vector<double> zeros(probes.size(), 0.0);
    bool past_zero = model.effects[a].low == 0;
    if (past_zero) add(0, 0, zeros);
    for (const Probe& p : probes[a]) {
      if (!past_zero && p.strength > 0) add(0, 0, zeros), past_zero = true;
      std::vector<double> from_rival(probes.size(), 0.0);
      for (std::size_t b = 0; b < probes.size(); ++b)
        if (b != a) from_rival[b] = distance_from(model, p.response, p.covariance, probes[b]);
      add(p.strength, std::sqrt(chi_squared(p.response, without_shape_error(model.effects[a], p), model)), from_rival);
    }
    if (!past_zero) add(0, 0, zeros);
    result.tables.push_back(std::move(table));
  }
  return result;
}

bool Isolability::knows(const std::string& effect) const { return index_of(*this, effect) < effects.size(); }

std::vector<std::string> Isolability::group_of(const std::string& effect, double strength) const {
  std::vector<std::string> group = {effect};
  if (!knows(effect)) return group;
  const StrengthTable& table = tables[index_of(*this, effect)];
  for (std::size_t b = 0; b < effects.size(); ++b)
    if (effects[b] != effect && table.at(strength, table.from_rival[b]) <= group_distance) group.push_back(effects[b]);
  return group;
}

double Isolability::from_nothing(const std::string& effect, double strength) const {
  if (!knows(effect)) return 0;
  const StrengthTable& table = tables[index_of(*this, effect)];
  return table.at(strength, table.from_nothing);
}

bool Isolability::detectable(const std::string& effect, double strength) const {
  return from_nothing(effect, strength) > detectable_distance;
}

bool Isolability::isolable(const std::string& effect, double strength) const {
  return detectable(effect, strength) && group_of(effect, strength).size() == 1;
}

double Isolability::farthest(const std::string& effect) const {
  const StrengthTable& table = tables[index_of(*this, effect)];
  const auto most = std::max_element(table.from_nothing.begin(), table.from_nothing.end());
  return table.strengths[static_cast<std::size_t>(most - table.from_nothing.begin())];
}

double Isolability::detectable_from(const std::string& effect) const {
  return first_strength(*this, effect, [&](double s) { return detectable(effect, s); });
}

double Isolability::isolable_from(const std::string& effect) const {
  return first_strength(*this, effect, [&](double s) { return isolable(effect, s); });
}

double Isolability::separation(std::size_t effect, std::size_t rival) const {
  const std::vector<double>& distances = tables[effect].from_rival[rival];
  return distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
}

nlohmann::ordered_json to_json(const Isolability& i) {
  nlohmann::ordered_json j;
  j["effects"] = i.effects;
  j["group_distance"] = i.group_distance;
  j["detectable_distance"] = i.detectable_distance;
  j["at_strength"] = nlohmann::ordered_json::object();
  for (std::size_t a = 0; a < i.effects.size(); ++a) {
    const StrengthTable& table = i.tables[a];
    auto& own = j["at_strength"][i.effects[a]] = {{"strengths", table.strengths}, {"from_nothing", table.from_nothing}};
    own["from_rival"] = nlohmann::ordered_json::object();
    for (std::size_t b = 0; b < i.effects.size(); ++b)
      if (a != b) own["from_rival"][i.effects[b]] = table.from_rival[b];
  }
  return j;
}

Isolability isolability_of_json(const nlohmann::ordered_json& j, const std::string& path) {
  Isolability i;
  try {
    i.effects = j.at("effects").get<std::vector<std::string>>();
    i.group_distance = j.at("group_distance");
    i.detectable_distance = j.at("detectable_distance");
    for (const std::string& effect : i.effects) {
      const auto& own = j.at("at_strength").at(effect);
      StrengthTable table{
          own.at("strengths").get<std::vector<double>>(), own.at("from_nothing").get<std::vector<double>>(), {}};
      if (table.strengths.empty() || table.from_nothing.size() != table.strengths.size())
        throw BadInput(path, 0, "holds no table of " + effect, "seal it again");
      for (const std::string& rival : i.effects) {
        table.from_rival.push_back(rival == effect ? std::vector<double>()
                                                   : own.at("from_rival").at(rival).get<std::vector<double>>());
        if (rival != effect && table.from_rival.back().size() != table.strengths.size())
          throw BadInput(path, 0, fmt::format("holds no table of {} from {}", effect, rival), "seal it again");
      }
      i.tables.push_back(std::move(table));
    }
  } catch (const nlohmann::json::exception&) {
    throw BadInput(path, 0, "holds no groups at strength", "seal it again with this version of vielto gap isolability");
  }
  return i;
}

std::string isolability_csv(const Isolability& i) {
  std::string text = "effect,strength,from_nothing,group";
  for (const std::string& name : i.effects) text += "," + name;
  text += "\n";
  for (std::size_t a = 0; a < i.effects.size(); ++a) {
    const StrengthTable& table = i.tables[a];
    for (std::size_t k = 0; k < table.strengths.size(); ++k) {
      const double s = table.strengths[k];
      text += fmt::format("{},{:.6g},{:.2f},{}", i.effects[a], s, table.from_nothing[k],
                          s == 0 ? "" : fmt::format("{}", fmt::join(i.group_of(i.effects[a], s), "+")));
      for (std::size_t b = 0; b < i.effects.size(); ++b)
        text += a == b ? "," : fmt::format(",{:.2f}", table.from_rival[b][k]);
      text += "\n";
    }
  }
  return text;
}

std::string isolability_svg(const Isolability& i) {
  const int m = static_cast<int>(i.effects.size()), cell = 40, left = 150, top = 150;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} "
      "{1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect "
      "width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"10\" y=\"20\">the row's effect from the column's "
      "at the strength where it is farthest, in standard "
      "deviations;</text>\n"
      "<text x=\"10\" y=\"36\">diagonal: from no effect. Grey: not "
      "told apart ({2:g}) or not detectable "
      "({3:g}).</text>\n",
      left + cell * m + 20, top + cell * m + 20, i.group_distance, i.detectable_distance);
  for (int a = 0; a < m; ++a) {
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", left - 6, top + cell * a + 25,
                       i.effects[a]);
    svg += fmt::format("<text transform=\"translate({},{}) rotate(-60)\">{}</text>\n", left + cell * a + 22, top - 6,
                       i.effects[a]);
    for (int b = 0; b < m; ++b) {
      const double d = a == b ? i.from_nothing(i.effects[static_cast<std::size_t>(a)],
                                               i.farthest(i.effects[static_cast<std::size_t>(a)]))
                              : i.separation(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
      const double limit = a == b ? i.detectable_distance : i.group_distance;
      // From light to dark blue between the limit and four times it; grey below.
      const int shade = static_cast<int>(220 - 170 * std::clamp((d - limit) / (3 * limit), 0.0, 1.0));
      const std::string colour = d <= limit ? "#dddddd" : fmt::format("rgb({},{},255)", shade, shade);
      svg += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" stroke=\"white\"/>"
          "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"{}\">{:.1f}</text>\n",
          left + cell * b, top + cell * a, cell, cell, colour, left + cell * b + cell / 2, top + cell * a + 25,
          shade < 120 && d > limit ? "white" : "black", d);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace vielto::gap
