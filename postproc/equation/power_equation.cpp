// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/power_equation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bad_input.h"
#include "core/json_file.h"
#include "core/mixing_numbers.h"
#include "core/statistics.h"

namespace vielto {
namespace {

using nlohmann::json;

const BulkMaterial* find_material(const std::vector<BulkMaterial>& materials, const std::string& name) {
  for (const BulkMaterial& m : materials)
    if (!name.empty() && m.name == name) return &m;
  return nullptr;
}

bool is_power(const Observation& row) { return row.apparatus == "mixer" && row.observable == "power"; }

bool is_grain(const BulkMaterial& material) { return material.bulk_density && material.bulk_cohesion; }

// The one grain that is given, if the power rows are all of one material: it stands for it, whatever its name there.
const BulkMaterial* only_grain(const std::vector<ReducedTable>& tables, const std::vector<BulkMaterial>& materials) {
  std::set<std::string> names;
  for (const ReducedTable& table : tables)
    for (const Observation& row : table.rows)
      if (is_power(row)) names.insert(row.material);
  if (names.size() != 1 || std::count_if(materials.begin(), materials.end(), is_grain) != 1) return nullptr;
  return &*std::find_if(materials.begin(), materials.end(), is_grain);
}

const BulkMaterial& grain_of(const Observation& row, const std::vector<BulkMaterial>& materials,
                             const BulkMaterial* only, const std::string& path, int line) {
  if (const BulkMaterial* own = find_material(materials, row.material)) {
    if (is_grain(*own)) return *own;
    throw BadInput(path, line, "material",
                   fmt::format("the card of '{}' does not state bulkDensity and bulkCohesion", own->name),
                   "add both to the card");
  }
  if (only) return *only;
  throw BadInput(path, line, "material", fmt::format("no card of '{}' is given", row.material),
                 "add --material with the card of that name");
}

FittedRange range_of(const json& j) { return {j.at(0).get<double>(), j.at(1).get<double>()}; }
json range_json(const FittedRange& range) { return json::array({range.low, range.high}); }

Eigen::VectorXd vector_of(const json& j) {
  const auto values = j.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

json vector_json(const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); }

// A relative slack for limits that went through a file or a sum of decimals.
constexpr double kRounding = 1e-9;
// Logarithm by which a prediction may miss an alias of the fit: cards state 4 digits.
constexpr double kAliasSlack = 1e-3;

std::string outside(const std::string& what, double value, const FittedRange& range) {
  if (value >= range.low * (1 - kRounding) && value <= range.high * (1 + kRounding)) return "";
  return fmt::format("{} = {:.4g} is outside {:.4g} to {:.4g}", what, value, range.low, range.high);
}

// Grain would be flung to the drum all the way round above Fr_M = 1, and a mixer of 10 1/s is none of this kind.
void note_revolutions_per_minute(PowerData& data) {
  for (const auto* rows : {&data.fit, &data.check})
    for (const PowerRow& row : *rows) {
      const double speed = *row.observation.speed, froude = mixing_froude_number(row.mixer.lever, speed);
      if (speed <= 10 && froude <= 1) continue;
      data.notes.push_back(
          fmt::format("{}, line {}: speed {:.6g} 1/s and Fr_M {:.3g}: is that 1/min? Speeds are in 1/s", row.file,
                      row.line, speed, froude));
      return;
    }
}

}  // namespace

std::string number_name(PowerNumber number) { return number == PowerNumber::n_pc ? "N_PC" : "N_P"; }

double power_scale(PowerNumber number, double speed, const MixerDimensions& mixer, const BulkMaterial& material) {
  return number == PowerNumber::n_pc ? 1 / cohesive_power_number(1, mixer.lever, speed, *material.bulk_cohesion)
                                     : 1 / power_number(1, mixer.lever, speed, *material.bulk_density);
}

PowerData power_data(const std::vector<ReducedTable>& tables, const std::vector<MixerDimensions>& mixers,
                     const std::vector<BulkMaterial>& materials) {
  PowerData data;
  const BulkMaterial* only = only_grain(tables, materials);
  std::vector<Eigen::Triplet<double>> covariance;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const ReducedTable& table = tables[t];
    const MixerDimensions& mixer = mixers[mixers.size() == 1 ? 0 : t];
    std::vector<int> index(table.rows.size(), -1);  // in the fit
    bool any = false;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const Observation& o = table.rows[i];
      if (!is_power(o)) continue;
      any = true;
      const int line = table.lines[i];
      const auto need = [&](const char* column, bool good) {
        if (!good)
          throw BadInput(table.path, line, column, "is missing or not above 0", "a power law needs it above 0");
      };
      need("speed", o.speed.value_or(0) > 0);
      need("fill", o.fill.value_or(0) > 0);
      if (!(o.value > 0))
        throw BadInput(table.path, line, "value", fmt::format("the grain's power is {:.6g} W", o.value),
                       "a power law needs it above 0; leave the row out of the fit");
      const BulkMaterial& grain = grain_of(o, materials, only, table.path, line);
      const PowerRow row{table.path, line,
                         o,          mixer,
                         grain,      groups_of(*o.fill, *o.speed, mixer, grain, find_material(materials, o.wall))};
      if (o.role == Role::fit) index[i] = static_cast<int>(data.fit.size());
      (o.role == Role::fit ? data.fit : data.check).push_back(row);
    }
    if (!any)
      throw BadInput(table.path, 0, "holds no mixer power", "add rows of power, or of power_loaded and power_idle");
    for (int column = 0; column < table.covariance.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator v(table.covariance, column); v; ++v)
        if (index[v.row()] >= 0 && index[v.col()] >= 0)
          covariance.emplace_back(index[v.row()], index[v.col()], v.value());
    if (!table.covariance_path.empty()) data.covariance_paths.push_back(table.covariance_path);
  }
  note_revolutions_per_minute(data);
  if (only) {
    const std::string& name = (data.fit.empty() ? data.check : data.fit).front().observation.material;
    if (!name.empty() && !only->name.empty() && name != only->name)
      data.notes.push_back(fmt::format("the rows name the material '{}', the card is '{}'", name, only->name));
  }
  const int n = static_cast<int>(data.fit.size());
  data.covariance.resize(n, n);
  data.covariance.setFromTriplets(covariance.begin(), covariance.end());
  return data;
}

double thesis_relative_u() {
  constexpr int kPoints = 16;
  return ThesisEquation::max_relative_error / expected_largest_magnitude(kPoints);
}

Equation thesis_equation() {
  Equation e;
  e.names = {"B0", "B1", "B2", "B3"};
  e.parameters = Eigen::Vector4d(std::log(ThesisEquation::factor), ThesisEquation::fill_exponent,
                                 ThesisEquation::cohesion_exponent, ThesisEquation::froude_exponent);
  e.covariance = Eigen::MatrixXd::Zero(4, 4);
  e.covariance(0, 0) = thesis_relative_u() * thesis_relative_u();
  e.quantile = kNormal975;
  e.lever = {MixerDimensions().lever, MixerDimensions().lever};
  // The ranges of the booklet (T3), widened by half a unit of their last digit.
  e.group_range[0] = FittedRange{ThesisEquation::low_fill, ThesisEquation::high_fill};
  e.group_range[1] = FittedRange{0.00035, 0.00435};
  e.group_range[2] = FittedRange{0.00255, 0.02915};
  return e;
}

json to_json(const Equation& e) {
  json covariance = json::array(), aliases = json::array(), ranges = json::object();
  for (Eigen::Index i = 0; i < e.covariance.rows(); ++i) covariance.push_back(vector_json(e.covariance.row(i)));
  for (const Alias& a : e.aliases)
    aliases.push_back({{"name", a.name}, {"constant", a.constant}, {"weights", vector_json(a.weights)}});
  for (int g = 0; g < kGroupCount; ++g)
    if (e.group_range[g]) ranges[kGroupNames[g]] = range_json(*e.group_range[g]);
  return {{"number", number_name(e.number)},
          {"names", e.names},
          {"parameters", vector_json(e.parameters)},
          {"covariance", covariance},
          {"quantile", e.quantile},
          {"scatter", e.scatter},
          {"aliases", aliases},
          {"group_range", ranges},
          {"lever_range", range_json(e.lever)},
          {"provisional", e.provisional}};
}

Equation read_equation(const std::string& path) {
  const json file = read_json_file(path, "name the file that `vielto fit --out` wrote");
  try {
    const json& j = file.at("prediction");
    Equation e;
    const auto number = j.at("number").get<std::string>();
    if (number != "N_PC" && number != "N_P") throw std::invalid_argument("number is neither N_PC nor N_P");
    e.number = number == "N_PC" ? PowerNumber::n_pc : PowerNumber::n_p;
    e.names = j.at("names").get<std::vector<std::string>>();
    e.parameters = vector_of(j.at("parameters"));
    const auto k = static_cast<Eigen::Index>(e.names.size());
    e.covariance.resize(k, k);
    for (Eigen::Index i = 0; i < k; ++i) {
      const Eigen::VectorXd row = vector_of(j.at("covariance").at(static_cast<std::size_t>(i)));
      if (row.size() != k || e.parameters.size() != k) throw std::invalid_argument("names and values differ in number");
      e.covariance.row(i) = row;
    }
    for (std::size_t i = 0; i < e.names.size(); ++i)
      if (i == 0 ? e.names[i] != "B0" : group_of_coefficient(e.names[i]) < 0)
        throw std::invalid_argument(fmt::format("'{}' is no coefficient", e.names[i]));
    e.quantile = j.at("quantile");
    e.scatter = j.at("scatter");
    for (const json& a : j.at("aliases")) {
      e.aliases.push_back({a.at("name"), a.at("constant"), vector_of(a.at("weights"))});
      if (e.aliases.back().weights.size() != k - 1) throw std::invalid_argument("an alias has another size");
    }
    for (int g = 0; g < kGroupCount; ++g)
      if (j.at("group_range").contains(kGroupNames[g])) e.group_range[g] = range_of(j["group_range"][kGroupNames[g]]);
    e.lever = range_of(j.at("lever_range"));
    e.provisional = j.at("provisional");
    return e;
  } catch (const std::exception& error) {
    throw BadInput(path, 0, fmt::format("is no fitted equation ({})", error.what()),
                   "name the file that `vielto fit --out` wrote");
  }
}

Prediction predict(const Equation& equation, const std::string& source, const Groups& groups, double speed,
                   const MixerDimensions& mixer, const BulkMaterial& material) {
  const auto k = static_cast<Eigen::Index>(equation.names.size());
  Eigen::VectorXd x = Eigen::VectorXd::Ones(k);
  for (Eigen::Index i = 1; i < k; ++i) {
    const int g = group_of_coefficient(equation.names[i]);
    if (!groups[g])
      throw BadInput(source, 0, fmt::format("holds {}, which is not known here", kGroupNames[g]),
                     "add --mixer, --material or --wall with a file that states what it needs");
    x[i] = std::log(*groups[g]);
  }
  for (const Alias& a : equation.aliases) {
    const auto own = std::find(equation.names.begin(), equation.names.end(), a.name) - equation.names.begin();
    if (std::fabs(x[own] - a.constant - a.weights.dot(x.tail(k - 1))) > kAliasSlack)
      throw BadInput(source, 0,
                     fmt::format("the fit does not determine {} apart, and this mixer and material need it", a.name),
                     fmt::format("fit rows that tell it apart, or fix it (--fix {}=VALUE)", a.name));
  }

  Prediction p;
  const double log_number = x.dot(equation.parameters), u = std::sqrt(x.dot(equation.covariance * x));
  const double scale = power_scale(equation.number, speed, mixer, material);
  const auto power_at = [&](double standard_errors, double sigma) {
    return scale * std::exp(log_number + standard_errors * sigma);
  };
  const double new_u = std::hypot(u, equation.scatter);
  p.number = std::exp(log_number);
  p.power = power_at(0, u);
  p.u = p.power * u;
  p.low95 = power_at(-equation.quantile, u);
  p.high95 = power_at(equation.quantile, u);
  p.new_low95 = power_at(-equation.quantile, new_u);
  p.new_high95 = power_at(equation.quantile, new_u);
  const auto note = [&](const std::string& text) {
    if (!text.empty()) p.outside.push_back(text);
  };
  bool geometry_known = true;  // by its ratios; else by the lever alone
  for (int g = 0; g < kGroupCount; ++g) {
    if (groups[g] && equation.group_range[g]) note(outside(kGroupNames[g], *groups[g], *equation.group_range[g]));
    if ((g == 3 || g == 5) && !(groups[g] && equation.group_range[g])) geometry_known = false;
  }
  if (!geometry_known) note(outside("L_kl", mixer.lever, equation.lever));
  return p;
}

}  // namespace vielto
