// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/stopping_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vielto {
namespace {

// sqrt(dof / chi^2(0.1, dof))
double upper_90(double dof) {
  const double z = 1.2816, ninth = 2 / (9 * dof), root = 1 - ninth - z * std::sqrt(ninth);
  return root > 0 ? 1 / std::sqrt(root * root * root) : std::numeric_limits<double>::infinity();
}

}  // namespace

Look look(const std::vector<double>& signal, int period, double target, int least) {
  Look l;
  l.part = find_steady_part(signal, period, least);
  if (l.part.verdict == Steadiness::too_few_turns) return l;
  const std::vector<double> kept(signal.begin() + static_cast<std::ptrdiff_t>(l.part.first) * period, signal.end());
  l.mean = mean_uncertainty(kept, period);
  const double mean = std::fabs(l.mean.mean), moved = 0.5 * std::fabs(l.part.slope) * l.part.count;
  if (!(mean > 0)) return l;
  l.relative = l.mean.u * upper_90(l.mean.dof) / mean;
  l.precise = l.mean.effective_samples >= kLeastEffective && l.relative <= target;
  l.steady = l.part.verdict == Steadiness::steady && moved <= target * mean;
  l.turns_needed = l.part.first + std::ceil(l.part.count * std::pow(l.relative / target, 2));
  return l;
}

void StoppingRule::add(double value) {
  signal_.push_back(value);
  if (signal_.size() % static_cast<std::size_t>(period_) != 0) return;
  last_ = look(signal_, period_, target_, least_);
  precise_ = last_.precise ? precise_ + 1 : 0;
  steady_ = last_.steady ? steady_ + 1 : 0;
  known_ = steady_ >= 2 && precise_ >= std::max(2, turns() / kShareOfLooks);
}

}  // namespace vielto
