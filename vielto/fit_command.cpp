// SPDX-License-Identifier: GPL-2.0-or-later
// vielto fit TABLE... --material CARD...: the mixing power as a power law of dimensionless groups.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "core/csv.h"
#include "equation/power_fit.h"
#include "material_options.h"

namespace vielto {
namespace {

struct FitOptions {
  std::vector<std::string> tables, mixers, groups = {"l", "N_C", "Fr_M"}, fixed;
  MaterialOptions materials;
  std::string number = "N_PC", objective = "absolute", out;
  bool unweighted = false, json = false;
};

int group_index(const std::string& name) {
  for (int g = 0; g < kGroupCount; ++g)
    if (kGroupNames[g] == name) return g;
  throw BadInput("--groups", 0, fmt::format("'{}' is no group", name),
                 fmt::format("choose from {}", fmt::join(kGroupNames, ", ")));
}

PowerFitRequest request_of(const FitOptions& o) {
  PowerFitRequest request;
  request.number = o.number == "N_PC" ? PowerNumber::n_pc : PowerNumber::n_p;
  request.groups.clear();
  for (const std::string& name : o.groups) request.groups.push_back(group_index(name));
  for (const std::string& text : o.fixed) {
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto value = equals == std::string::npos ? std::nullopt : finite_number(text.substr(equals + 1));
    if (!value || (name == "B0" ? !(*value > 0) : group_of_coefficient(name) < 0))
      throw BadInput("--fix " + text, 0, "fixes no coefficient", "write B0 to B8, '=' and a number, such as B3=-0.25");
    if (!request.fixed.emplace(name, *value).second)
      throw BadInput("--fix " + text, 0, "fixes a coefficient twice", "state it once");
  }
  request.objective = o.objective == "absolute" ? Objective::absolute
                      : o.objective == "log"    ? Objective::log
                                                : Objective::relative;
  request.weighted = !o.unweighted;
  return request;
}

void fit(const FitOptions& o) {
  const PowerFitRequest request = request_of(o);
  const std::vector<BulkMaterial> materials = o.materials.read();
  std::vector<MixerDimensions> mixers;
  for (const std::string& path : o.mixers) mixers.push_back(MixerDimensions::read(path));
  if (mixers.empty()) mixers.emplace_back();
  if (mixers.size() != 1 && mixers.size() != o.tables.size())
    throw BadInput("--mixer", 0, fmt::format("{} mixers stand for {} tables", mixers.size(), o.tables.size()),
                   "give one mixer, or one for each table in their order");
  PowerFit result;
  if (are_long(o.tables)) {
    result = fit_power(request, PowerStream(o.tables, mixers, materials));
  } else {
    std::vector<ReducedTable> tables;
    for (const std::string& path : o.tables) tables.push_back(read_reduced_table(path));
    result = fit_power(request, power_data(tables, mixers, materials));
  }
  if (!o.out.empty()) write_whole_file(o.out, power_fit_json(result).dump(2) + "\n");
  std::fputs((o.json ? power_fit_json(result).dump(2) + "\n" : power_fit_text(result)).c_str(), stdout);
}

}  // namespace

void add_fit_command(CLI::App& app) {
  auto o = std::make_shared<FitOptions>();
  CLI::App* command = app.add_subcommand(
      "fit",
      "coefficients of N_PC = B0 l^B1 N_C^B2 Fr_M^B3 ... from observation tables\n"
      "Rows of role fit make the coefficients, rows of role check are predicted. The covariance of the rows is read "
      "from\n"
      "TABLE.covariance.csv or covariance.csv beside the table. Exponents that the rows do not tell apart are not "
      "stated;\n"
      "their determined combination is (in one material: B2+B3).\n"
      "Example: vielto fit thesis_equation.csv --material hulled_millet.par --fix B3=-0.25 --out equation.json");
  command->add_option("TABLE", o->tables, "observation tables")->required();
  o->materials.add_to(command);
  command->add_option(
      "--mixer", o->mixers,
      "mixer file (mixer.par), one for all tables or one each; without it L_kl = 0.114 m and no geometry groups");
  command->add_option("--number", o->number, "the power number on the left")
      ->check(CLI::IsMember({"N_PC", "N_P"}))
      ->capture_default_str();
  command
      ->add_option("--groups", o->groups, fmt::format("groups of the equation, from {}", fmt::join(kGroupNames, ",")))
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--fix", o->fixed, "fix a coefficient, such as B3=-0.25 (repeatable)");
  command
      ->add_option("--objective", o->objective,
                   "error made small: absolute (y - f, weighted by u), log (ln y - ln f, weighted by u/y), "
                   "relative ((y - f)/y, rows alike)")
      ->check(CLI::IsMember({"absolute", "relative", "log"}))
      ->capture_default_str();
  command->add_flag("--unweighted", o->unweighted, "every row counts the same, u and covariance are not used");
  command->add_flag("--json", o->json, "print JSON instead of tables");
  command->add_option("--out", o->out, "also write the JSON here, for `vielto predict --equation`");
  command->callback([o] { fit(*o); });
}

}  // namespace vielto
