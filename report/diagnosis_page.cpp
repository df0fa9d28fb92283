// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/diagnosis_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

namespace vielto::gap {
namespace {

using json = nlohmann::ordered_json;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

// A horizontal bar of `part` (0 to 1) of the width.
std::string bar(double part, const char* colour) {
  return fmt::format("<svg width=\"220\" height=\"14\"><rect width=\"{:.1f}\" height=\"14\" fill=\"{}\"/></svg>",
                     220 * std::clamp(part, 0.0, 1.0), colour);
}

// Relative gap to either side of a middle line, `full` at the edge.
std::string signed_bar(double value, double full, const char* colour) {
  const double length = 110 * std::min(1.0, std::fabs(value) / full);
  return fmt::format(
      "<svg width=\"220\" height=\"14\"><rect x=\"{:.1f}\" width=\"{:.1f}\" height=\"14\" fill=\"{}\"/>"
      "<line x1=\"110\" x2=\"110\" y2=\"14\" stroke=\"black\"/></svg>",
      value < 0 ? 110 - length : 110, length, colour);
}

// What makes most of the uncertainty of a region or a trend: the sources with a quarter of u^2 or more, greatest first.
// `unit` is 100 for per cent.
std::string mostly_from(const json& region, double unit, const char* format) {
  std::vector<std::pair<double, std::string>> parts;
  for (const auto& [name, u] : region["u_parts"].items()) parts.emplace_back(u.get<double>(), name);
  std::sort(parts.rbegin(), parts.rend());
  const double u = region["u"].get<double>();
  std::string text;
  for (const auto& [part, name] : parts)
    if (part * part >= u * u / 4)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, fmt::format(fmt::runtime(format), unit * part));
  return text;
}

std::string map_of_the_gap(const json& where) {
  double full = 0.05;
  for (const json& r : where) full = std::max(full, std::fabs(r["relative_gap"].get<double>()));
  std::string rows;
  for (const json& r : where) {
    const bool found = r["q_value"].get<double>() <= 0.05;
    rows += fmt::format(
        "<tr><td>{} {}</td><td>{}</td><td>{}</td><td class=n>{:+.1f} %</td><td class=n>{:.1f} %</td><td>{}</td><td "
        "class=n>{:+.1f}</td><td class=n>{:.2g}</td></tr>\n",
        r["apparatus"].get<std::string>(), r["observable"].get<std::string>(), r["region"].get<std::string>(),
        signed_bar(r["relative_gap"], full, found ? "#c0392b" : "#bbbbbb"), 100 * r["relative_gap"].get<double>(),
        100 * r["u"].get<double>(), mostly_from(r, 100, "{:.0f} %"), r["z"].get<double>(), r["q_value"].get<double>());
  }
  return "<table><tr><th>observable</th><th>region</th><th>simulated against "
         "measured</th><th>gap</th><th>u</th><th>u mostly from</th><th>z</th><th>q</th></tr>\n" +
         rows +
         "</table>\n<p>Gap: simulated over measured, less 1. u: its relative standard uncertainty, all that is "
         "uncertain "
         "included; z: of its logarithm. Red: a gap, at a "
         "false-discovery rate of 5 %. Grey: a gap smaller than about twice its u cannot be told from nothing.</p>\n";
}

std::string trends_table(const json& trends) {
  std::string rows;
  for (const json& t : trends)
    rows += fmt::format(
        "<tr><td>{} {}</td><td>{}</td><td class=n>{:+.2f}</td><td class=n>{:.2f}</td><td>{}</td><td "
        "class=n>{:+.1f}</td><td class=n>{:.2g}</td></tr>\n",
        t["apparatus"].get<std::string>(), t["observable"].get<std::string>(), t["condition"].get<std::string>(),
        t["exponent"].get<double>(), t["u"].get<double>(), mostly_from(t, 1, "{:.2f}"), t["z"].get<double>(),
        t["q_value"].get<double>());
  if (rows.empty()) return "";
  return "<p>Measured over simulated goes with the condition to the power</p>\n<table><tr><th>observable</th>"
         "<th>condition</th><th>exponent</th><th>u</th><th>u mostly from</th><th>z</th><th>q</th></tr>\n" +
         rows + "</table>\n";
}

// "No gap" says as little as the data can show: how large a gap would have been seen, and what hides a smaller one.
std::string without_a_gap(const json& where) {
  const json* largest = nullptr;
  for (const json& r : where)
    if (!largest || std::fabs(r["relative_gap"].get<double>()) > std::fabs((*largest)["relative_gap"].get<double>()))
      largest = &r;
  if (!largest) return "";
  return fmt::format(
      "<p>That is no proof that the simulation is right: the largest difference seen ({} {}, {}: {:+.0f} %) has a "
      "standard uncertainty of {:.0f} %, mostly from {}. A smaller u there is what would show more.</p>\n",
      (*largest)["apparatus"].get<std::string>(), (*largest)["observable"].get<std::string>(),
      (*largest)["region"].get<std::string>(), 100 * (*largest)["relative_gap"].get<double>(),
      100 * (*largest)["u"].get<double>(), mostly_from(*largest, 100, "{:.0f} %"));
}

// Whether there is a gap at all hangs on a threshold that is itself known from so many draws only.
std::string close_call(const json& odds) {
  const double best = odds["best_rival"].get<double>(), low = odds["threshold_low95"].get<double>(),
               high = odds["threshold_high95"].get<double>();
  if (best < low || best > high) return "";
  return fmt::format(
      "<p><b>A close call:</b> the log odds of the best rival over no gap, {:.1f}, lie within the uncertainty of the "
      "threshold, {:.1f} (95 %: {:.1f} &hellip; {:.1f}).</p>\n",
      best, odds["threshold"].get<double>(), low, high);
}

// A verdict on single regions and effects can miss what goes through all of them, or be of nothing else.
std::string trends_found(const json& trends, const char* words) {
  std::string text;
  for (const json& t : trends)
    if (t["q_value"].get<double>() <= 0.05)
      text += fmt::format(
          "<p><b>{}:</b> {} {}, measured over simulated, goes with {} to the power {:+.2f} &plusmn; "
          "{:.2f} (q {:.2g}).</p>\n",
          words, t["apparatus"].get<std::string>(), t["observable"].get<std::string>(),
          t["condition"].get<std::string>(), t["exponent"].get<double>(), t["u"].get<double>(),
          t["q_value"].get<double>());
  return text;
}

// Where in the machine the simulated torque arises, and where the effects change it.
std::string percent(double share) {
  const double whole = std::round(100 * share);
  return fmt::format("{:.0f} %", whole == 0 ? 0.0 : whole);  // no -0
}

// A row a source, a column a condition; in the cells the shares, and what the effects in question change.
std::string sources_of_kind(const json& sources, const std::string& kind) {
  std::vector<std::string> conditions, names;
  std::map<std::pair<std::string, std::string>, std::string> cells;
  const auto place = [](std::vector<std::string>& all, const std::string& name) {
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  };
  for (const json& s : sources) {
    if (s["kind"] != kind) continue;
    const std::string condition =
        fmt::format("{:g} 1/s, l = {:g}", s["speed"].is_null() ? 0.0 : s["speed"].get<double>(),
                    s["fill"].is_null() ? 0.0 : s["fill"].get<double>());
    const std::string name = s["source"];
    place(conditions, condition);
    place(names, name);
    std::string cell = percent(s["share"].get<double>());
    for (const json& e : s["effects"])
      cell += fmt::format("<br><small>{} at {:.3g}: {:+.0f} &plusmn; {:.0f} %</small>",
                          escaped(e["name"].get<std::string>()), e["strength"].get<double>(),
                          100 * e["change"].get<double>(), 100 * e["u"].get<double>());
    cells[{name, condition}] = cell;
  }
  if (names.empty()) return "";
  if (kind == "phase")
    std::sort(names.begin(), names.end(),
              [](const std::string& x, const std::string& y) { return std::atof(x.c_str()) < std::atof(y.c_str()); });
  std::string text = "<table><tr><th>source</th>";
  for (const std::string& condition : conditions) text += fmt::format("<th class=n>{}</th>", condition);
  text += "</tr>\n";
  for (const std::string& name : names) {
    text += fmt::format("<tr><td>{}</td>", escaped(name));
    for (const std::string& condition : conditions)
      text += fmt::format("<td class=n>{}</td>", cells[{name, condition}]);
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string sources_table(const json& sources) {
  std::string text;
  for (const auto& [kind, words] :
       {std::pair("part",
                  "Parts of the simulated rotor torque; drum: what its wall takes back, the rest is the weight "
                  "of the grain."),
        std::pair("phase",
                  "The paddles' torque by the place of a paddle in its turn; 0 deg is the lowest point, from "
                  "which it rises."),
        std::pair("loss", "Where the work goes: dashpots (normal, tangential), sliding, rolling, twisting.")}) {
    if (const std::string table = sources_of_kind(sources, kind); !table.empty())
      text += fmt::format("<p>{}</p>\n{}", words, table);
  }
  return text;
}

std::string ranking(const json& probabilities) {
  std::vector<std::pair<double, std::string>> models;
  for (const auto& [name, p] : probabilities.items()) models.emplace_back(p.get<double>(), name);
  std::sort(models.rbegin(), models.rend());
  std::string rows;
  for (std::size_t i = 0; i < models.size() && i < 8; ++i)
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=n>{:.1f} %</td></tr>\n",
                        models[i].second == "no_gap" ? "no gap" : escaped(models[i].second),
                        bar(models[i].first, "#2c6fbb"), 100 * models[i].first);
  return "<table>" + rows + "</table>\n";
}

// Of an ambiguous group: how strong each would have to be.
std::string strengths_table(const json& strengths) {
  std::string rows;
  for (const auto& [name, s] : strengths.items()) {
    const std::string unit = s["unit"];
    rows += fmt::format("<tr><td>{}</td><td class=n>{:.3g}{}</td><td class=n>{:.3g} &hellip; {:.3g}</td></tr>\n",
                        escaped(name), s["value"].get<double>(), unit == "1" ? "" : " " + unit,
                        s["low90"].get<double>(), s["high90"].get<double>());
  }
  return "<p>If it is the one, its strength is</p>\n<table><tr><th>effect</th><th class=n>strength</th><th class=n>90 "
         "%</th></tr>\n" +
         rows + "</table>\n";
}

std::string before_and_after(const json& shrink, const std::string& how, bool effect_known) {
  const double full = std::max({shrink["before"].get<double>(), shrink["recalibrated"].get<double>(),
                                shrink["after"].get<double>(), shrink["placebo"].get<double>(), 1e-9});
  std::string rows;
  // without an effect outside the group there is no placebo to show
  const std::string placebo = shrink.value("placebo_effect", std::string());
  for (const auto& [key, name] : {std::pair<const char*, std::string>{"before", "baseline"},
                                  {"recalibrated", "recalibrated only"},
                                  {"after", "with the effect"},
                                  {"placebo", "placebo (" + placebo + ")"}}) {
    if (key == std::string("placebo") && placebo.empty()) continue;
    if (key == std::string("after") && !effect_known) continue;  // an unknown effect cannot be added
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=n>{:.1f} %</td></tr>\n", escaped(name),
                        bar(shrink[key].get<double>() / full, "#27866a"), 100 * shrink[key].get<double>());
  }
  return fmt::format(
      "<p>Root-mean-square gap on {} check tests, {}, measurement noise taken out. Closed: {:.0f} % (90 %: {:.0f} to "
      "{:.0f} %, from the noise of measurement and simulation{}).</p>\n<table>{}</table>\n",
      shrink["tests"].get<int>(), how, 100 * shrink["closed"]["value"].get<double>(),
      100 * shrink["closed"]["low90"].get<double>(), 100 * shrink["closed"]["high90"].get<double>(),
      shrink["tests"].get<int>() < 5 ? "; so few tests say nothing about others" : " and from which tests there are",
      rows);
}

}  // namespace

std::string diagnosis_page(const json& d, const std::string& title) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\"><title>{0}</title>\n<style>body{{font-family:sans-serif;"
      "max-width:52em;margin:2em auto;padding:0 1em}}table{{border-collapse:collapse}}td,th{{padding:.15em "
      ".7em;text-align:left}}"
      ".n{{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}}.verdict{{font-size:1.3em;border-"
      "left:.3em solid "
      "#2c6fbb;"
      "padding-left:.7em}}</style></head><body>\n<h1>{0}</h1>\n<p class=\"verdict\">{1}</p>\n",
      escaped(title), escaped(d["sentence"].get<std::string>()));
  const double absorbable = 100 * d["absorbable_by_recalibration"].get<double>();
  page += d["verdict"] == "no_gap"
              ? fmt::format(
                    "<p>{:.0f} % of the difference that is seen lies within what recalibration could take up.</p>\n",
                    absorbable)
              : fmt::format(
                    "<p>{:.0f} % of the gap could be absorbed by recalibration, {:.0f} % needs something new.</p>\n",
                    absorbable, 100 - absorbable);
  page += close_call(d["log_odds"]);
  if (d["verdict"] == "no_gap") page += trends_found(d["trends"], "But a trend is off") + without_a_gap(d["where"]);
  if (d["verdict"] == "unknown") page += trends_found(d["trends"], "What is off is a trend");
  page += "<h2>Where</h2>\n" + map_of_the_gap(d["where"]) + trends_table(d["trends"]);
  page += "<h2>Which effect</h2>\n" + ranking(d["probabilities"]);
  if (d["verdict"] == "ambiguous") page += strengths_table(d["strength"]);
  page += "<h2>How far the gap closes</h2>\n";
  if (!d["shrink"].is_null()) page += before_and_after(d["shrink"], "simulated again", d["verdict"] != "unknown");
  if (!d["shrink_predicted"].is_null())
    page += before_and_after(d["shrink_predicted"], "predicted by the emulator, no proof", true);
  if (d["shrink"].is_null() && d["shrink_predicted"].is_null())
    page += "<p>Not asked: no effect was named, or there are no check tests.</p>\n";
  page += "<h2>Next test</h2>\n";
  if (d["next_test"].is_null())
    page += d["verdict"] == "no_gap" ? "<p>None: there is no proven gap whose cause a test could tell.</p>\n"
                                     : "<p>None is needed to tell effects apart.</p>\n";
  else
    page += fmt::format(
        "<p><b>{}</b> ({}): separates {}; from {:.1f} to {:.1f} standard deviations in {:g} h.</p>\n",
        escaped(d["next_test"]["name"].get<std::string>()), escaped(d["next_test"]["how"].get<std::string>()),
        escaped(d["next_test"]["separates"].get<std::string>()), d["next_test"]["separation_now"].get<double>(),
        d["next_test"]["separation"].get<double>(), d["next_test"]["hours"].get<double>());
  if (d.contains("sources") && !d["sources"].empty())
    page += "<h2>Where in the machine</h2>\n" + sources_table(d["sources"]);
  page += "<h2>How firm</h2>\n<table><tr><th>if</th><th>verdict</th><th>best rival</th><th>its share</th></tr>\n";
  for (const json& s : d["sensitivity"])
    page += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td class=n>{:.0f} %</td></tr>\n",
                        escaped(s["change"].get<std::string>()), s["verdict"].get<std::string>(),
                        escaped(s["top"].get<std::string>()), 100 * s["probability"].get<double>());
  page += fmt::format(
      "</table>\n<p>Log odds of the best rival against no gap {:.1f}, threshold {:.1f} from {} draws.</p>\n",
      d["log_odds"]["best_rival"].get<double>(), d["log_odds"]["threshold"].get<double>(),
      d["log_odds"]["draws"].get<int>());
  for (const json& note : d["notes"]) page += "<p>Note: " + escaped(note.get<std::string>()) + "</p>\n";
  return page + "</body></html>\n";
}

}  // namespace vielto::gap
