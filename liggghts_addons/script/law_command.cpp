// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/law_command.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "input.h"
#include "script/command_line.h"
#include "variable.h"
#include "vielto_stop.h"

namespace vielto {
namespace {

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool same_value(const std::string& a, const std::string& b) {
  return a == b || (is_number(a) && is_number(b) && std::stod(a) == std::stod(b));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); k++)
    text += (k == 0 ? "" : k + 1 == words.size() ? " or " : ", ") + words[k];
  return text;
}

// Whether one of the law's own formulas or settings names this parameter of the rigs.
bool takes(const Law& law, const std::string& parameter) {
  const std::string reference = "${" + parameter + "}";
  const auto in = [&](const std::string& text) { return text.find(reference) != std::string::npos; };
  for (const auto& [name, formula] : law.settings)
    if (in(formula)) return true;
  for (const auto& [name, formula] : law.steps)
    if (in(formula)) return true;
  for (const LawProperty& p : law.properties)
    if (in(p.grain) || in(p.wall)) return true;
  return false;
}

}  // namespace

void LawCommand::command(int narg, char** arg) {
  const std::string what = narg > 1 ? arg[1] : "";
  if (narg == 1)
    choose();
  else if (what == "properties" && narg == 2)
    properties();
  else if (what == "friction" && narg == 4)
    friction(arg[2], arg[3]);
  else
    stop("vielto: write 'vielto law', 'vielto law properties' or 'vielto law friction GRAIN WALL'");
}

void LawCommand::choose() {
  const Law& law = chosen();
  set_parameters();
  const char* const given = variable("cohesion");
  const std::string cohesion = given ? given : "off";
  check_cohesion(law, cohesion);
  const bool cohesive = cohesion != "off";
  // LIGGGHTS takes the models in this order only
  std::string models = "model " + law.normal;
  if (!law.tangential.empty()) models += " tangential " + law.tangential;
  if (cohesive) models += " cohesion " + cohesion;
  if (!law.rolling.empty()) models += " rolling_friction " + law.rolling;
  std::string words;
  for (const auto& [keyword, formula] : law.settings)
    words += (words.empty() ? "" : " ") + keyword + " " + filled(formula);
  set("models", models);
  set("settings", words);
  set("cohesive", cohesive ? "1" : "0");
  set("lawTakesClumps", law.clumps ? "1" : "0");
}

void LawCommand::properties() {
  const Law& law = chosen();
  set_parameters();
  check_lacks(law);
  for (const auto& [name, formula] : law.steps) run("variable " + name + " equal " + filled(formula));
  for (const auto& [condition, line] : law.refusals)
    run("if \"" + filled(condition) + "\" then \"vielto error " + filled(line) + "\"");
  for (const std::string& line : law.commands) run(line);
  for (const LawProperty& p : law.properties) make(p, p.grain, p.wall);
}

void LawCommand::friction(const std::string& grain, const std::string& wall) {
  const Law& law = chosen();
  const auto with = [&](const std::string& formula) {
    return replaced(replaced(formula, "${frictionAngle}", grain), "${wall_frictionAngle}", wall);
  };
  for (const LawProperty& p : law.properties)
    if (p.rule.name == law.friction) {
      run("unfix " + law.friction);
      make(p, with(p.grain), with(p.wall));
    }
}

const Law& LawCommand::chosen() {
  const char* const name = variable("law");
  const Law* const law = find_law(name ? name : "");
  if (!law) stop(std::string("vielto: law is '") + (name ? name : "") + "'; give " + law_names() + " with -var law");
  return *law;  // cppcheck-suppress nullPointerRedundantCheck ; stop() does not return
}

// Of all laws: a parameter of another law than the chosen one is known, and refused as such.
void LawCommand::set_parameters() {
  for (const Law& law : laws())
    for (const LawParameter& p : law.parameters) {
      run(std::string("variable ") + p.rule.name + " index " + p.value);
      check_parameter(p);
    }
}

void LawCommand::check_parameter(const LawParameter& p) {
  const std::string name = p.rule.name, now = variable(name);
  const std::vector<std::string> words = choices(p.rule.unit);
  if (!words.empty()) {
    if (!contains(words, now))
      stop("vielto: " + name + " is '" + now + "'; give " + p.rule.unit + " with -var " + name);
    return;
  }
  const double v = is_number(now) ? std::stod(now) : std::nan("");
  const bool high = p.rule.lowAllowed ? v >= p.rule.low : v > p.rule.low;
  const bool low = p.rule.highAllowed ? v <= p.rule.high : v < p.rule.high;
  if (!high || !low)
    stop("vielto: " + name + " is '" + now + "'; give a number in " + range_of(p.rule) + " (" + p.rule.unit +
         ") with -var " + name);
}

void LawCommand::check_cohesion(const Law& law, const std::string& cohesion) {
  if (cohesion == "off" || contains(law.cohesions, cohesion)) return;
  std::vector<std::string> good = law.cohesions;
  good.push_back("off");
  stop("vielto: law " + law.name + " takes no cohesion " + cohesion + ": " +
       (law.cohesionAdvice.empty() ? "give " + listed(good) + " with -var cohesion" : law.cohesionAdvice));
}

void LawCommand::check_lacks(const Law& law) {
  const std::vector<std::string> given = names_on_command_line();
  for (const std::string& item : law.lacks) {
    const std::size_t equals = item.find('=');
    const std::string base = item.substr(0, equals);
    for (const std::string& name : {base, "wall_" + base})
      if (equals != std::string::npos)
        refuse_unless(law, name, item.substr(equals + 1));
      else if (contains(given, name))
        stop("vielto: law " + law.name + " has no counterpart of " + name + "; leave out -var " + name);
  }
  for (const Law& other : laws())
    for (const LawParameter& p : other.parameters)
      if (!takes(law, p.rule.name)) refuse_unless(law, p.rule.name, p.value);
  if (law.energies.empty()) refuse_unless(law, "energyBalance", "off");
}

void LawCommand::refuse_unless(const Law& law, const std::string& name, const std::string& value) {
  const char* const now = variable(name);
  if (now && !same_value(now, value))
    stop("vielto: law " + law.name + " has no counterpart of " + name + " " + now + "; give -var " + name + " " +
         value);
}

void LawCommand::make(const LawProperty& p, const std::string& grain, const std::string& wall) {
  const std::string name = p.rule.name;
  switch (p.form) {
    case LawProperty::PER_TYPE:
      return run("vielto property " + name + " " + value_of(grain) + " " + value_of(wall));
    case LawProperty::PER_PAIR:
      return run("vielto pair_property " + name + " " + value_of(grain) + " " + value_of(wall));
    case LawProperty::SCALAR:
      return run("fix " + name + " all property/global " + name + " scalar " + value_of(grain));
  }
}

// Every ${NAME} by its value.
std::string LawCommand::filled(const std::string& text) {
  std::string done;
  std::size_t from = 0;
  for (std::size_t at = text.find("${"); at != std::string::npos; at = text.find("${", from)) {
    const std::size_t end = text.find('}', at);
    const std::string name = text.substr(at + 2, end - at - 2);
    const char* const now = variable(name);
    if (!now) stop("vielto: law needs the variable " + name + "; the rigs' parameter files and cards state it");
    done += text.substr(from, at - from) + now;
    from = end + 1;
  }
  return done + text.substr(from);
}

// A plain number stays as it was written; a formula is worked out by LIGGGHTS, to its 15 digits.
std::string LawCommand::value_of(const std::string& formula) {
  const std::string text = filled(formula);
  if (is_number(text)) return text;
  run("variable law_value equal " + text);
  return variable("law_value");
}

const char* LawCommand::variable(const std::string& name) {
  std::string text = name;
  return input->variable->retrieve(&text[0]);
}

void LawCommand::set(const std::string& name, const std::string& value) {
  std::string text[3] = {name, "string", value};
  char* words[3] = {&text[0][0], &text[1][0], &text[2][0]};
  input->variable->set(3, words);
}

void LawCommand::run(const std::string& line) { input->one(line.c_str()); }

void LawCommand::stop(const std::string& line) { stop_all(lmp, line.c_str()); }

}  // namespace vielto
