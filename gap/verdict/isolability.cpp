// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/verdict/isolability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/verdict/evidence.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Every `step`-th strength of the response and its ends.
std::vector<double> probe_strengths(const EffectResponse& e, Index step) {
  std::vector<double> s;
  for (Index k = 0; k < e.strengths.size(); k += step) s.push_back(e.strengths[k]);
  if (e.high > 0) s.push_back(e.high);
  return s;
}

}  // namespace

double distance(const TableModel& model, const EffectResponse& a, double s, const EffectResponse& b) {
  const VectorXd ra = a.response(s);
  const MatrixXd ca = model.null_covariance() + model.uncertain(a, s);
  double least = chi_squared(ra, ca, model);  // b at 0
  for (const double t : probe_strengths(b, 2))
    least = std::min(least, chi_squared(ra - b.response(t), ca + model.uncertain(b, t), model));
  return std::sqrt(least);
}

Isolability isolability(const TableModel& model, const Settings& settings) {
  Isolability result;
  result.group_distance = settings.group_distance;
  result.detectable_distance = settings.detectable_distance;
  const Index m = static_cast<Index>(model.effects.size());
  result.separation = MatrixXd::Zero(m, m);
  result.detectability = VectorXd::Zero(m);
  const MatrixXd null = model.null_covariance();
  for (Index a = 0; a < m; ++a) {
    const EffectResponse& e = model.effects[a];
    result.effects.push_back(e.name);
    for (const double s : probe_strengths(e, 6)) {  // the farthest one is at an end or broad
      if (s == 0) continue;
      result.detectability[a] =
          std::max(result.detectability[a], std::sqrt(chi_squared(e.response(s), null + e.emulator(s), model)));
      for (Index b = 0; b < m; ++b)
        if (b != a)
          result.separation(a, b) = std::max(result.separation(a, b), distance(model, e, s, model.effects[b]));
    }
  }
  for (Index a = 0; a < m; ++a) {
    result.groups.emplace_back();
    for (Index b = 0; b < m; ++b)
      if (a == b || std::max(result.separation(a, b), result.separation(b, a)) <= settings.group_distance)
        result.groups.back().push_back(result.effects[b]);
  }
  return result;
}

std::vector<std::string> Isolability::group_of(const std::string& effect) const {
  const auto at = std::find(effects.begin(), effects.end(), effect);
  return at == effects.end() ? std::vector<std::string>{effect} : groups[at - effects.begin()];
}

bool Isolability::detectable(const std::string& effect) const {
  const auto at = std::find(effects.begin(), effects.end(), effect);
  return at != effects.end() && detectability[at - effects.begin()] > detectable_distance;
}

std::string isolability_csv(const Isolability& i) {
  std::string text = "effect,detectability,group";
  for (const std::string& name : i.effects) text += "," + name;
  text += "\n";
  for (std::size_t a = 0; a < i.effects.size(); ++a) {
    text += fmt::format("{},{:.2f},{}", i.effects[a], i.detectability[static_cast<Index>(a)],
                        fmt::join(i.group_of(i.effects[a]), "+"));
    for (std::size_t b = 0; b < i.effects.size(); ++b)
      text += fmt::format(",{:.2f}", i.separation(static_cast<Index>(a), static_cast<Index>(b)));
    text += "\n";
  }
  return text;
}

std::string isolability_svg(const Isolability& i) {
  const int m = static_cast<int>(i.effects.size()), cell = 40, left = 150, top = 150;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"10\" y=\"20\">separation of the row's effect from the column's, in standard deviations;</text>\n"
      "<text x=\"10\" y=\"36\">diagonal: from no effect. Grey: not told apart ({2:g}) or not detectable "
      "({3:g}).</text>\n",
      left + cell * m + 20, top + cell * m + 20, i.group_distance, i.detectable_distance);
  for (int a = 0; a < m; ++a) {
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", left - 6, top + cell * a + 25,
                       i.effects[a]);
    svg += fmt::format("<text transform=\"translate({},{}) rotate(-60)\">{}</text>\n", left + cell * a + 22, top - 6,
                       i.effects[a]);
    for (int b = 0; b < m; ++b) {
      const double d = a == b ? i.detectability[a] : i.separation(a, b);
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
