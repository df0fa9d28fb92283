// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/diagnosis_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/bad_input.h"
#include "gap/answer/verdict.h"
#include "report/diagnosis_plots.h"
#include "report/json_table.h"

namespace vielto::gap {
namespace {

using nlohmann::json;

constexpr double kFalseDiscoveries = 0.05;
constexpr std::size_t kShownCauses = 8;
constexpr double kShownProbability = 0.01, kShownPair = 0.1;
constexpr std::size_t kListedCauses = 30;
constexpr const char* kMend = "make it again with vielto gap diagnose";

std::string text(const json& j, const char* key) { return j.at(key).get<std::string>(); }
double number(const json& j, const char* key) { return j.at(key).get<double>(); }

std::string percent(double share, const char* format = "{:.0f} %") {
  const double rounded = std::round(1000 * share) / 10;
  return fmt::format(fmt::runtime(format), std::fabs(rounded) < 0.5 ? std::fabs(rounded) : rounded);  // no -0
}

// The name of an effect, of two, or of none of them, as it is read.
std::string cause(const std::string& name) {
  if (name == "no_gap") return "no gap";
  if (name == "unknown") return "something not in the library";
  std::string words;
  for (const char c : name) words += c == '_' ? " " : c == '+' ? " and " : std::string(1, c);
  return words;
}

std::string place(const json& region) {
  std::string words = text(region, "apparatus") + " " + text(region, "observable");
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

// What makes most of the uncertainty of a region or a trend: the sources with a quarter of u^2 or more, greatest first.
// `unit` is 100 for per cent.
std::string mostly_from(const json& region, double unit, const char* format) {
  std::vector<std::pair<double, std::string>> parts;
  for (const auto& [name, u] : region.at("u_parts").items()) parts.emplace_back(u.get<double>(), name);
  std::sort(parts.rbegin(), parts.rend());
  const double u = number(region, "u");
  std::string words;
  for (const auto& [part, name] : parts)
    if (part * part >= u * u / 4)
      words += fmt::format("{}{} {}", words.empty() ? "" : ", ", name, fmt::format(fmt::runtime(format), unit * part));
  return words;
}

// The region with the surest gap, or of no sure one that with the largest; null without regions.
const json* worst_region(const json& where) {
  const json* worst = nullptr;
  const auto weight = [](const json& r) {
    return std::pair(number(r, "q_value") <= kFalseDiscoveries ? std::fabs(number(r, "z")) : 0.0,
                     std::fabs(number(r, "relative_gap")));
  };
  for (const json& r : where)
    if (!worst || weight(r) > weight(*worst)) worst = &r;
  return worst;
}

// "No gap" says as little as the data can show: how large a gap would have been seen, and what hides a smaller one.
std::string without_a_gap(const json& where) {
  const json* largest = nullptr;
  for (const json& r : where)
    if (!largest || std::fabs(number(r, "relative_gap")) > std::fabs(number(*largest, "relative_gap"))) largest = &r;
  if (!largest) return "";
  return fmt::format(
      "That is no proof that the simulation is right: the largest difference seen ({}, {}: {}) has a standard "
      "uncertainty of {}, mostly from {}. A smaller u there is what would show more.",
      place(*largest), text(*largest, "region"), percent(number(*largest, "relative_gap"), "{:+.0f} %"),
      percent(number(*largest, "u")), mostly_from(*largest, 100, "{:.0f} %"));
}

// Whether there is a gap at all hangs on a threshold that is itself known from so many draws only.
std::string close_call(const json& odds) {
  const double best = number(odds, "best_rival"), low = number(odds, "threshold_low95"),
               high = number(odds, "threshold_high95");
  if (best < low || best > high) return "";
  return fmt::format(
      "A close call: the log odds of the best rival over no gap, {:.1f}, lie within the uncertainty of the threshold, "
      "{:.1f} (95 %: {:.1f} … {:.1f}).",
      best, number(odds, "threshold"), low, high);
}

// A verdict on single regions and effects can miss what goes through all of them, or be of nothing else.
std::vector<std::string> trends_found(const json& trends, const char* words) {
  std::vector<std::string> lines;
  for (const json& t : trends)
    if (number(t, "q_value") <= kFalseDiscoveries)
      lines.push_back(
          fmt::format("{}: {}, measured over simulated, goes with {} to the power {:+.2f} ± {:.2f} (q {:.2g}).", words,
                      place(t), text(t, "condition"), number(t, "exponent"), number(t, "u"), number(t, "q_value")));
  return lines;
}

std::string strength_words(const json& strength) {
  const std::string unit = text(strength, "unit");
  return fmt::format("{:.3g}{} ({:.3g} … {:.3g})", number(strength, "value"), unit == "1" ? "" : " " + unit,
                     number(strength, "low90"), number(strength, "high90"));
}

const json* effect_entry(const json& d, const std::string& name) {
  for (const json& e : d.at("effects"))
    if (e.at("name") == name) return &e;
  return nullptr;
}

std::vector<std::pair<double, std::string>> causes(const json& d) {
  std::vector<std::pair<double, std::string>> list;
  for (const auto& [name, p] : d.at("probabilities").items()) list.emplace_back(p.get<double>(), name);
  std::sort(list.rbegin(), list.rend());
  return list;
}

bool has_strengths(const json& d) { return d.contains("fit_gap"); }

Table ranking(const json& d) {
  Table table;
  table.columns = {"cause", "probability"};
  table.bar_column = 1;
  const bool more = has_strengths(d);
  if (more) {
    table.columns.insert(table.columns.end(), {"strength it would have (90 %)", "gap left with it"});
    table.caption = fmt::format("The gap of the fit rows is {}, root mean square; {} is left by recalibration alone.",
                                percent(number(d["fit_gap"], "before")), percent(number(d["fit_gap"], "recalibrated")));
  }
  double other_pairs = 0;
  for (const auto& [p, name] : causes(d)) {
    const bool pair = name.find('+') != std::string::npos;
    if (pair && p < kShownPair) other_pairs += p;
    if ((pair && p < kShownPair) || table.rows.size() == kShownCauses ||
        (p < kShownProbability && table.rows.size() >= 3))
      continue;
    std::vector<std::string> row = {cause(name), percent(p, "{:.1f} %")};
    if (more) {
      const json* e = effect_entry(d, name);
      const bool told = e && e->contains("strength");
      row.push_back(told ? strength_words((*e)["strength"]) : kNotRecorded);
      row.push_back(told ? percent(number(*e, "gap_left")) : kNotRecorded);
    }
    table.rows.push_back(row);
    table.bars.push_back(p);
  }
  table.rows.push_back({"any other two together", percent(other_pairs, "{:.1f} %")});
  table.rows.back().resize(table.columns.size(), kNotRecorded);
  table.bars.push_back(other_pairs);
  return table;
}

// Of an ambiguous group: how strong each would have to be.
Table strengths_table(const json& d) {
  Table table{"If it is the one, its strength is", {"effect", "strength (90 %)"}, {}};
  for (const json& name : d.at("group"))
    table.rows.push_back({cause(name), strength_words(d.at("strength").at(name.get<std::string>()))});
  return table;
}

Table regions_table(const json& where) {
  Table table{
      "Gap: simulated over measured, less 1. u: its relative standard uncertainty, of all that is uncertain; z: of "
      "its logarithm. q: the rate of false discoveries at which it counts as found.",
      {"observable", "region", "gap, %", "u, %", "u mostly from", "z", "q", "found"},
      {}};
  for (const json& r : where)
    table.rows.push_back({place(r), text(r, "region"), fmt::format("{:+.1f}", 100 * number(r, "relative_gap")),
                          fmt::format("{:.1f}", 100 * number(r, "u")), mostly_from(r, 100, "{:.0f} %"),
                          fmt::format("{:+.1f}", number(r, "z")), fmt::format("{:.2g}", number(r, "q_value")),
                          number(r, "q_value") <= kFalseDiscoveries ? "yes" : "no"});
  return table;
}

Table trends_table(const json& trends) {
  Table table{"Measured over simulated goes with the condition to the power",
              {"observable", "condition", "exponent", "u", "u mostly from", "z", "q"},
              {}};
  for (const json& t : trends)
    table.rows.push_back({place(t), text(t, "condition"), fmt::format("{:+.2f}", number(t, "exponent")),
                          fmt::format("{:.2f}", number(t, "u")), mostly_from(t, 1, "{:.2f}"),
                          fmt::format("{:+.1f}", number(t, "z")), fmt::format("{:.2g}", number(t, "q_value"))});
  return table;
}

std::string regions_found(const json& where) {
  std::vector<std::string> found;
  for (const json& r : where)
    if (number(r, "q_value") <= kFalseDiscoveries)
      found.push_back(fmt::format("{}, {}: {} ± {}", place(r), text(r, "region"),
                                  percent(number(r, "relative_gap"), "{:+.0f} %"), percent(number(r, "u"))));
  if (found.empty())
    return "No region by itself is off by more than its uncertainty, at a false-discovery rate of 5 %.";
  return fmt::format("Found at a false-discovery rate of 5 %, with standard uncertainty: {}.", fmt::join(found, "; "));
}

// A row a source, a column a condition; in the cells the shares, and what the effects in question change.
Table sources_table(const json& sources, const std::string& kind, const char* words) {
  std::vector<std::string> conditions, names;
  std::map<std::pair<std::string, std::string>, std::string> cells;
  const auto add = [](std::vector<std::string>& all, const std::string& name) {
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  };
  const auto condition = [](const json& s, const char* key) { return s.at(key).is_null() ? 0.0 : number(s, key); };
  for (const json& s : sources) {
    if (s.at("kind") != kind) continue;
    const std::string at = fmt::format("{:g} 1/s, l = {:g}", condition(s, "speed"), condition(s, "fill"));
    add(conditions, at);
    add(names, text(s, "source"));
    std::string cell = percent(number(s, "share"));
    for (const json& e : s.at("effects"))
      cell += fmt::format("; {} at {:.3g}: {} ± {}", cause(text(e, "name")), number(e, "strength"),
                          percent(number(e, "change"), "{:+.0f} %"), percent(number(e, "u")));
    cells[{text(s, "source"), at}] = cell;
  }
  if (kind == "phase")
    std::sort(names.begin(), names.end(),
              [](const std::string& x, const std::string& y) { return std::atof(x.c_str()) < std::atof(y.c_str()); });
  Table table{words, {"source"}, {}};
  table.columns.insert(table.columns.end(), conditions.begin(), conditions.end());
  for (const std::string& name : names) {
    table.rows.push_back({name});
    for (const std::string& at : conditions) table.rows.back().push_back(cells[{name, at}]);
  }
  return table;
}

void add_sources(const json& sources, Page& page) {
  Section section{"Where in the machine the simulated torque arises", {}, true};
  for (const auto& [kind, words] :
       {std::pair("part",
                  "Parts of the rotor's torque; drum: what its wall takes back, the rest is the weight of the "
                  "grain."),
        std::pair("standing", "What the parts that stand take back."),
        std::pair("phase",
                  "The paddles' torque by the place of a paddle in its turn; 0 deg is the lowest point, from "
                  "which it rises."),
        std::pair("loss", "Where the work goes: dashpots (normal, tangential), sliding, rolling, twisting.")})
    if (Table table = sources_table(sources, kind, words); !table.rows.empty()) section.blocks.push_back(table);
  if (!section.blocks.empty()) page.sections.push_back(std::move(section));
}

void add_shrink(const json& shrink, const std::string& how, bool effect_known, Section& section) {
  const int tests = shrink.at("tests").get<int>();
  const json& closed = shrink.at("closed");
  section.blocks.push_back(Paragraph{fmt::format(
      "Root-mean-square gap on {} check tests, {}, measurement noise taken out. Closed: {} (90 %: "
      "{} to {}, from the noise of measurement and simulation{}).",
      tests, how, percent(number(closed, "value")), percent(number(closed, "low90")), percent(number(closed, "high90")),
      tests < 5 ? "; so few tests say nothing about others" : " and from which tests there are")});
  Table table{"", {"simulation", "gap"}, {}};
  table.bar_column = 1;
  double full = 1e-9;
  // without an effect outside the group there is no placebo to show
  const std::string placebo = shrink.value("placebo_effect", std::string());
  for (const auto& [key, name] : {std::pair<const char*, std::string>{"before", "as calibrated"},
                                  {"recalibrated", "recalibrated only"},
                                  {"after", "with the effect"},
                                  {"placebo", "with a wrong effect: " + cause(placebo)}}) {
    if (key == std::string("placebo") && placebo.empty()) continue;
    if (key == std::string("after") && !effect_known) continue;  // an unknown effect cannot be added
    table.rows.push_back({name, percent(number(shrink, key), "{:.1f} %")});
    table.bars.push_back(number(shrink, key));
    full = std::max(full, number(shrink, key));
  }
  for (double& bar : table.bars) bar /= full;
  section.blocks.push_back(table);
}

std::string next_test_words(const json& t) {
  return fmt::format("{} ({:g} h): {}. It separates {}: from {:.1f} to {:.1f} standard deviations.",
                     cause(text(t, "name")), number(t, "hours"), text(t, "how"), cause(text(t, "separates")),
                     number(t, "separation_now"), number(t, "separation"));
}

// The numbers that a manager looks for first.
void add_figures(const json& d, Verdict verdict, Page& page) {
  const std::map<Verdict, const char*> words = {{Verdict::no_gap, "No gap"},
                                                {Verdict::named, "Cause named"},
                                                {Verdict::ambiguous, "Cause not settled"},
                                                {Verdict::unknown, "Cause not in the library"}};
  const auto rows = d.value("rows", json::object());
  page.figures.push_back(
      {"Verdict", words.at(verdict),
       fmt::format("{} rows to attribute, {} held out", rows.value("fit", 0), rows.value("check", 0))});
  if (const json* r = worst_region(d.at("where")))
    page.figures.push_back(
        {number(*r, "q_value") <= kFalseDiscoveries ? "Surest gap" : "Largest difference",
         fmt::format("{} ± {}", percent(number(*r, "relative_gap"), "{:+.0f}"), percent(number(*r, "u"))),
         place(*r) + ", " + text(*r, "region")});
  for (const auto& [p, name] : causes(d)) {
    if (name == "no_gap" && verdict != Verdict::no_gap) continue;
    page.figures.push_back({verdict == Verdict::no_gap ? "Probability of no gap" : "Likeliest cause",
                            verdict == Verdict::no_gap ? percent(number(d["probabilities"], "no_gap")) : cause(name),
                            verdict == Verdict::no_gap ? "" : percent(p)});
    break;
  }
  page.figures.push_back(
      {"Recalibration could absorb", percent(number(d, "absorbable_by_recalibration")), "of the gap"});
  const char* key = d.at("shrink").is_null() ? "shrink_predicted" : "shrink";
  if (const json s = d.value(key, json()); !s.is_null() && verdict != Verdict::unknown)
    page.figures.push_back({"Gap on held-out tests",
                            fmt::format("{} → {}", percent(number(s, "before")), percent(number(s, "after"))),
                            key == std::string("shrink") ? "simulated again with the effect" : "predicted, no proof"});
  if (!d.at("next_test").is_null())
    page.figures.push_back(
        {"Next test", cause(text(d["next_test"], "name")), fmt::format("{:g} h", number(d["next_test"], "hours"))});
}

void add_summary(const json& d, Verdict verdict, Page& page) {
  const bool none = verdict == Verdict::no_gap;
  const double absorbable = number(d, "absorbable_by_recalibration");
  page.summary.push_back(
      {none ? fmt::format("{} of the difference that is seen lies within what recalibration could take up.",
                          percent(absorbable))
            : fmt::format("{} of the gap could be absorbed by recalibration, {} needs something new.",
                          percent(absorbable), percent(1 - absorbable))});
  if (d.contains("why_it_is_off"))
    page.summary.push_back(
        {fmt::format("Without the reference, why the simulation is off: {}", text(d["why_it_is_off"], "sentence"))});
  if (const std::string close = close_call(d.at("log_odds")); !close.empty())
    page.summary.push_back({close, Paragraph::Tone::warning});
  const json trends = d.value("trends", json::array());
  if (none || verdict == Verdict::unknown)
    for (const std::string& line : trends_found(trends, none ? "But a trend is off" : "What is off is a trend"))
      page.summary.push_back({line, Paragraph::Tone::warning});
  if (none)
    if (const std::string line = without_a_gap(d.at("where")); !line.empty()) page.summary.push_back({line});
}

// The effects that the points after are simulated with: the named ones, or the likeliest of a group.
std::string with_effect(const json& d) {
  std::string words;
  for (const json& name : d.at("named")) words += (words.empty() ? "with " : " and ") + cause(name);
  if (words.empty() && !d.at("group").empty()) words = "with " + cause(d["group"][0]);
  return words;
}

// The points, and what the runs of the proof say there.
json with_runs(const json& d) {
  constexpr double kBand = 1.96;
  json points = d.at("points");
  const json shrink = d.value("shrink", json());
  if (shrink.is_null()) return points;
  for (const json& run : shrink.value("runs", json::array()))
    for (json& point : points)
      for (const char* variant : {"before", "after"})
        if (point.at("test") == run.at("test") && point.at("observable") == run.at("observable") &&
            run.contains(variant)) {
          const double value = number(run[variant], "value"), half = kBand * number(run[variant], "u");
          point[std::string(variant) + "_again"] = {
              {"value", value}, {"low95", value - half}, {"high95", value + half}};
        }
  return points;
}

void add_plots(const json& d, const std::string& name, Page& page) {
  Section compared{"Measured against simulated", {}};
  if (!d.contains("points")) {
    compared.blocks.push_back(Paragraph{
        "This diagnosis.json has no points: `vielto gap diagnose` on its table writes them, and the plots with them."});
    page.sections.push_back(std::move(compared));
    return;
  }
  const json& points = d["points"];
  const bool effect = std::any_of(points.begin(), points.end(), [](const json& p) { return p.contains("after"); });
  std::string words = fmt::format(
      "Measured values have 95 % intervals. The lines and bands of the simulation, as calibrated{}, are the "
      "emulator's: "
      "95 %, of all that is uncertain about it.",
      effect ? " and with the effect in question" : "");
  if (const json shrink = d.value("shrink", json()); !shrink.is_null() && shrink.contains("runs"))
    words += " Points called \"run again\" are the runs of the proof.";
  compared.blocks.push_back(Paragraph{words});
  const auto plots = comparison_plots(with_runs(d), name, with_effect(d));
  std::vector<Section> more;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    Section folded{"Measured against simulated over " + cause(plots[i].over), {}, true};
    const bool first = i == 0 || plots[i].over.empty();
    for (const Plot& plot : plots[i].plots) (first ? compared : folded).blocks.push_back(plot);
    if (!first) more.push_back(std::move(folded));
  }
  page.sections.push_back(std::move(compared));
  for (Section& section : more) page.sections.push_back(std::move(section));
}

void add_details(const json& d, Page& page) {
  Section regions{"Every region and trend", {regions_table(d.at("where"))}, true};
  if (const json trends = d.value("trends", json::array()); !trends.empty())
    regions.blocks.push_back(trends_table(trends));
  page.sections.push_back(std::move(regions));
  if (const json sources = d.value("sources", json::array()); !sources.empty()) add_sources(sources, page);

  Section firm{"How firm the verdict is", {}, true};
  Table table{"What would be said with other assumptions", {"if", "verdict", "best rival", "its share"}, {}};
  for (const json& s : d.value("sensitivity", json::array()))
    table.rows.push_back(
        {text(s, "change"), cause(text(s, "verdict")), cause(text(s, "top")), percent(number(s, "probability"))});
  firm.blocks.push_back(table);
  const json& odds = d.at("log_odds");
  firm.blocks.push_back(
      Paragraph{fmt::format("Log odds of the best rival against no gap {:.1f}, threshold {:.1f} from {} "
                            "draws.",
                            number(odds, "best_rival"), number(odds, "threshold"), odds.at("draws").get<int>())});
  Table all{"The most probable causes", {"cause", "probability, %"}, {}};
  for (const auto& [p, name] : causes(d))
    if (all.rows.size() < kListedCauses) all.rows.push_back({cause(name), fmt::format("{:.2f}", 100 * p)});
  firm.blocks.push_back(all);
  page.sections.push_back(std::move(firm));

  Section provenance{"Where the diagnosis comes from", {}, true};
  provenance.blocks.push_back(json_table(d.value("provenance", json::object())));
  page.sections.push_back(std::move(provenance));
}

// What the changed state is compared with, and how far one run of each observable scatters.
Section reference_state(const json& r) {
  Section section{"The reference state", {}};
  section.blocks.push_back(
      Paragraph{fmt::format("The question is what has changed since this state, in which the model was validated: {} "
                            "rows of {}. The calibrated simulation describes them with a probability of {:.2g}.",
                            r.at("rows").get<int>(), text(r, "table"), number(r, "chi2_probability"))});
  if (number(r, "transfer") > 0)
    section.blocks.push_back(Paragraph{
        fmt::format("{} of what calibration and law leave open is left in.", percent(number(r, "transfer")))});
  Table table{"How far one run scatters", {"observable", "one run, %", "the library's seeds, %", "known from"}, {}};
  for (const json& s : r.at("scatter"))
    table.rows.push_back({place(s), fmt::format("{:.1f}", 100 * number(s, "sd")),
                          fmt::format("{:.1f}", 100 * number(s, "library")),
                          fmt::format("repeats with {:g} degrees of freedom{}", number(s, "degrees_of_freedom"),
                                      s.at("assumed").get<bool>() ? "; widened, since so few exclude little" : "")});
  section.blocks.push_back(table);
  return section;
}

void add_sections(const json& d, Verdict verdict, const std::string& name, Page& page) {
  if (d.contains("reference") && !d["reference"].is_null()) page.sections.push_back(reference_state(d["reference"]));
  add_plots(d, name, page);

  Section map{"Map of the gap", {Paragraph{regions_found(d.at("where"))}}};
  if (auto maps = d.contains("points") ? gap_maps(d["points"], name, with_effect(d)) : std::vector<Plot>();
      !maps.empty()) {
    map.blocks.push_back(
        Paragraph{"Simulated over measured, less 1. Red: the simulation shows too much. Blue: too little."});
    for (Plot& plot : maps) map.blocks.push_back(std::move(plot));
  }
  page.sections.push_back(std::move(map));

  Section which{"Which cause", {ranking(d)}};
  if (verdict == Verdict::ambiguous && !has_strengths(d)) which.blocks.push_back(strengths_table(d));
  page.sections.push_back(std::move(which));

  Section far{"How far the gap closes", {}};
  if (!d.at("shrink").is_null()) add_shrink(d["shrink"], "simulated again", verdict != Verdict::unknown, far);
  if (const json s = d.value("shrink_predicted", json()); !s.is_null())
    add_shrink(s, "predicted by the emulator, no proof", true, far);
  if (far.blocks.empty())
    far.blocks.push_back(Paragraph{"Not asked: no effect was named, or there are no check tests."});
  page.sections.push_back(std::move(far));

  Section next{"Next test", {}};
  if (!d.at("next_test").is_null())
    next.blocks.push_back(Paragraph{next_test_words(d["next_test"])});
  else
    next.blocks.push_back(Paragraph{verdict == Verdict::no_gap
                                        ? "None: there is no proven gap whose cause a test could tell."
                                        : "None is needed to tell effects apart."});
  page.sections.push_back(std::move(next));
  if (const json notes = d.value("notes", json::array()); !notes.empty()) {
    Section section{"Notes", {}, true};
    for (const json& note : notes) section.blocks.push_back(Paragraph{note.get<std::string>()});
    page.sections.push_back(std::move(section));
  }
  add_details(d, page);
}

}  // namespace

bool is_diagnosis(const json& j) {
  return j.is_object() && j.contains("verdict") && j.contains("probabilities") && j.contains("sentence");
}

void add_diagnosis(const json& d, const std::string& path, const std::string& name, Page& page) {
  try {
    page.sentence = text(d, "sentence");
    std::replace(page.sentence.begin(), page.sentence.end(), '_', ' ');
    const std::optional<Verdict> verdict = verdict_of(text(d, "verdict"));
    if (!verdict)
      throw BadInput(path, 0, fmt::format("is no diagnosis (its verdict is '{}')", text(d, "verdict")), kMend);
    add_figures(d, *verdict, page);
    add_summary(d, *verdict, page);
    add_sections(d, *verdict, name, page);
  } catch (const json::exception& error) {
    throw BadInput(path, 0, fmt::format("is no diagnosis ({})", error.what()), kMend);
  }
}

std::string diagnosis_page(const nlohmann::ordered_json& diagnosis, const std::string& title) {
  Page page;
  page.title = title;
  page.files_beside = false;
  add_diagnosis(json(diagnosis), "diagnosis.json", "", page);
  return page_html(page, std::filesystem::exists(web_file("echarts.min.js")));
}

}  // namespace vielto::gap
