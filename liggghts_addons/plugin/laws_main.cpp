// SPDX-License-Identifier: GPL-2.0-or-later
// vielto_laws [--json]: the contact laws from their descriptions (engine/law.h), as a page of Markdown or as JSON.
#include <stdio.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/law.h"

namespace {

using vielto::Law;
using vielto::LawProperty;
using Json = nlohmann::ordered_json;

const std::string unit_of(const vielto::PropertyRule& rule) { return rule.unit; }

// "${wall_youngsModulus}" is `wall_youngsModulus` to a reader.
std::string readable(const std::string& formula) {
  std::string text;
  for (std::size_t k = 0; k < formula.size(); k++)
    if (formula.compare(k, 2, "${") == 0)
      k++;
    else if (formula[k] != '}')
      text += formula[k];
  return text;
}

std::string listed(const std::vector<std::string>& words, const std::string& none) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? none : text;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

void print_section(const Law& law) {
  printf("\n## %s\n\n%s\n\n```\npair_style gran %s SETTINGS\n```\n\n", law.name.c_str(), law.summary.c_str(),
         models_of(law).c_str());
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"source", law.source},
      {"equations", code(law.header)},
      {"in Yade", law.yade},
      {"cohesion", listed(law.cohesions, "none of LIGGGHTS': " + law.cohesionAdvice)},
      {"energy accounts", listed(law.energies, "none")},
      {"clumps", law.clumps ? "yes" : "no"},
      {"time step", law.timeScale}};
  printf("| | |\n|---|---|\n");
  for (const auto& [name, text] : facts) printf("| %s | %s |\n", name.c_str(), text.c_str());
  printf("\n| property | unit | range | grain | wall |\n|---|---|---|---|---|\n");
  for (const LawProperty& p : law.properties)
    printf("| `%s`%s | %s | %s | %s | %s |\n", p.rule.name, p.form == LawProperty::PER_PAIR ? ", of a pair" : "",
           p.rule.unit, range_of(p.rule).c_str(), code(readable(p.grain)).c_str(), code(readable(p.wall)).c_str());
  if (!law.steps.empty()) {
    printf("\nwith\n\n");
    for (const auto& [name, formula] : law.steps) printf("- `%s = %s`\n", name.c_str(), readable(formula).c_str());
  }
  printf("\n| setting | in the rigs |\n|---|---|\n");
  for (const auto& [keyword, formula] : law.settings)
    printf("| `%s` | `%s` |\n", keyword.c_str(), readable(formula).c_str());
  if (!law.parameters.empty()) {
    printf("\n| parameter of this law only | value | unit | u | range | |\n|---|---|---|---|---|---|\n");
    for (const vielto::LawParameter& p : law.parameters) {
      const bool words = unit_of(p.rule).find(" or ") != std::string::npos;
      printf("| `%s` | %s | %s | %s | %s | %s |\n", p.rule.name, p.value.c_str(), p.rule.unit, p.uncertainty.c_str(),
             words ? "-" : range_of(p.rule).c_str(), p.source.c_str());
    }
  }
  if (!law.lacks.empty())
    printf("\nNo counterpart, refused if given (with =: any other value): %s.\n", code(listed(law.lacks, "")).c_str());
  if (!law.differs.empty()) {
    printf("\nAlso not as in ViElTo:\n\n");
    for (const std::string& text : law.differs) printf("- %s\n", text.c_str());
  }
}

Json json_of(const Law& law) {
  Json properties = Json::array(), parameters = Json::array(), settings = Json::object(), steps = Json::object();
  for (const LawProperty& p : law.properties)
    properties.push_back({{"name", p.rule.name},
                          {"unit", p.rule.unit},
                          {"range", range_of(p.rule)},
                          {"of", p.form == LawProperty::PER_TYPE   ? "type"
                                 : p.form == LawProperty::PER_PAIR ? "pair"
                                                                   : "all"},
                          {"grain", readable(p.grain)},
                          {"wall", readable(p.wall)}});
  for (const vielto::LawParameter& p : law.parameters)
    parameters.push_back(
        {{"name", p.rule.name}, {"value", p.value}, {"unit", p.rule.unit}, {"u", p.uncertainty}, {"source", p.source}});
  for (const auto& [keyword, formula] : law.settings) settings[keyword] = readable(formula);
  for (const auto& [name, formula] : law.steps) steps[name] = readable(formula);
  return {{"name", law.name},           {"summary", law.summary},
          {"source", law.source},       {"header", law.header},
          {"yade", law.yade},           {"models", models_of(law)},
          {"cohesions", law.cohesions}, {"settings", settings},
          {"parameters", parameters},   {"steps", steps},
          {"properties", properties},   {"lacks", law.lacks},
          {"differs", law.differs},     {"energies", law.energies},
          {"clumps", law.clumps},       {"time_scale", law.timeScale}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  if (argc > 2 || (!option.empty() && option != "--json")) {
    fprintf(stderr, "vielto_laws: write 'vielto_laws' for a page of Markdown or 'vielto_laws --json'\n");
    return 2;
  }
  if (option == "--json") {
    Json all = Json::array();
    for (const Law& law : vielto::laws()) all.push_back(json_of(law));
    printf("%s\n", Json({{"schema", 1}, {"laws", all}}).dump(2).c_str());
    return 0;
  }
  printf(
      "# Contact laws\n\nMade by `vielto_laws` from the laws' descriptions (`liggghts_addons/plugin/laws/`). Every rig "
      "runs "
      "each of them with\n`-var law NAME`. The columns *grain* and *wall* are formulas of the cards' parameters, in "
      "LIGGGHTS' "
      "language of variables;\nof a pair: grain on grain and grain on wall.\n");
  for (const Law& law : vielto::laws()) print_section(law);
  return 0;
}
