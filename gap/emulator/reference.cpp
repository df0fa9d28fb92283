// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/emulator/reference.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/bad_input.h"
#include "core/condition.h"
#include "core/statistics.h"
#include "gap/emulator/unknown_gap.h"

namespace vielto::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Reference rows come first.
struct Blocks {
  Index n, m;  // reference, changed
  MatrixXd of00(const MatrixXd& x) const { return x.topLeftCorner(n, n); }
  MatrixXd of10(const MatrixXd& x) const { return x.bottomLeftCorner(m, n); }
  MatrixXd of11(const MatrixXd& x) const { return x.bottomRightCorner(m, m); }
  // Covariance of k1 - W k0.
  MatrixXd difference(const MatrixXd& x, const MatrixXd& w) const {
    const MatrixXd wx = w * of10(x).transpose();
    return of11(x) - wx - wx.transpose() + w * of00(x) * w.transpose();
  }
};

// What the reference departs by from the simulation, in the model's coordinates.
VectorXd residual(const TableModel& logs, const VectorXd& reference) {
  VectorXd r(reference.size());
  for (Index i = 0; i < r.size(); ++i) {
    const bool logarithmic = logs.logarithmic[i] > 0;
    if (logarithmic && !(reference[i] > 0)) {
      const Observation& row = logs.rows[static_cast<std::size_t>(i)];
      throw BadInput("--reference, test " + row.test, 0, row.observable + " is not above 0", "leave the row out");
    }
    r[i] = (logarithmic ? std::log(reference[i]) : reference[i]) - logs.baseline[i] - logs.family_shift[i];
  }
  return r;
}

MatrixXd scatter(const MatrixXd& members, const VectorXd& mean, const VectorXd& weights) {
  const MatrixXd centred = members.colwise() - mean;
  return centred * weights.asDiagonal() * centred.transpose();
}

bool same_bench_row(const Observation& a, const Observation& b) {
  return a.apparatus == "bench" && b.apparatus == "bench" && a.observable == b.observable &&
         conditions_text(a) == conditions_text(b);
}

// What a bench row may have been off by in both states, its variance in K_00, K_10 and K_11: all that an effect can do.
MatrixXd bench_offsets(const TableModel& logs, Index n) {
  MatrixXd common = MatrixXd::Zero(logs.size(), logs.size());
  for (Index i = 0; i < n; ++i)
    for (Index j = n; j < logs.size(); ++j) {
      if (!same_bench_row(logs.rows[static_cast<std::size_t>(i)], logs.rows[static_cast<std::size_t>(j)])) continue;
      double most = 0;
      for (const EffectResponse& e : logs.effects) most = std::max(most, e.mean.row(j).cwiseAbs().maxCoeff());
      common(i, i) = common(j, j) = common(i, j) = common(j, i) = most * most;
    }
  return common;
}

// In logarithms, with what cancels between the states in the discrepancy.
TableModel both_states(const TableModel& joint, Index n) {
  TableModel logs = joint.in_logarithms(TableModel::Values::placeholders);
  logs.discrepancy += bench_offsets(logs, n);
  return logs;
}

}  // namespace

VectorXd expected_reference(const TableModel& joint, Index n) {
  const TableModel logs = joint.in_logarithms(TableModel::Values::placeholders);
  VectorXd expected = (logs.baseline + logs.family_shift).head(n);
  for (Index i = 0; i < n; ++i)
    if (logs.logarithmic[i] > 0) expected[i] = std::exp(expected[i]);
  return expected;
}

double reference_probability(const TableModel& joint, const VectorXd& reference) {
  const Index n = reference.size();
  const TableModel logs = both_states(joint, n);
  const VectorXd r = residual(logs, reference);
  const MatrixXd c = logs.null_covariance().topLeftCorner(n, n);
  return chi2_exceedance(r.dot(c.llt().solve(r)), static_cast<double>(n));
}

TableModel given_reference(const TableModel& joint, const VectorXd& reference, double transfer,
                           const Settings& settings) {
  const Index n = reference.size(), m = joint.size() - n;
  const Blocks blocks{n, m};
  const TableModel logs = both_states(joint, n);
  const MatrixXd k = logs.emulator + logs.family + logs.discrepancy;
  const MatrixXd own = blocks.of00(k + logs.noise + logs.seed);
  const MatrixXd w = own.llt().solve((blocks.of10(k) + blocks.of10(logs.noise)).transpose()).transpose();
  const VectorXd shift = w * residual(logs, reference);

  std::vector<Index> changed(static_cast<std::size_t>(m));
  for (Index i = 0; i < m; ++i) changed[static_cast<std::size_t>(i)] = n + i;
  TableModel p = joint.part(changed);
  VectorXd ratio = VectorXd::Ones(m), unit = VectorXd::Ones(m);  // of new to old f; of values to coordinates
  for (Index i = 0; i < m; ++i) {
    const bool logarithmic = logs.logarithmic[n + i] > 0;
    if (logarithmic) ratio[i] = std::exp(shift[i]);
    p.baseline[i] = logarithmic ? p.baseline[i] * ratio[i] : p.baseline[i] + shift[i];
    if (logarithmic) unit[i] = p.baseline[i];
  }
  const auto in_units = [&](const MatrixXd& x) { return MatrixXd(unit.asDiagonal() * x * unit.asDiagonal()); };
  p.scale = p.scale.cwiseProduct(ratio);
  p.seed = ratio.asDiagonal() * p.seed * ratio.asDiagonal();
  p.emulator = in_units(blocks.difference(logs.emulator, w));
  p.discrepancy = in_units(blocks.difference(logs.discrepancy, w));

  const bool shared = !blocks.of10(logs.noise).isZero(0);
  MatrixXd left = w * blocks.of00(logs.seed) * w.transpose() + transfer * blocks.of11(k);
  if (shared)
    p.noise = in_units(blocks.difference(logs.noise, w));
  else
    left += w * blocks.of00(logs.noise) * w.transpose();
  p.reference = in_units(left);

  // Members as factors of the new f, their emulator's error apart from their own scatter.
  const VectorXd& weights = logs.family_weights;
  const MatrixXd uncertain = weights.size() > 0
                                 ? MatrixXd(logs.family - scatter(logs.family_members, logs.family_shift, weights))
                                 : logs.family;
  const MatrixXd members = logs.family_members.bottomRows(m) -
                           w * (logs.family_members.topRows(n).colwise() - VectorXd(logs.family_shift.head(n)));
  p.family_members = members;
  for (Index i = 0; i < m; ++i)
    if (logs.logarithmic[n + i] > 0) p.family_members.row(i) = unit[i] * members.row(i).array().expm1();
  p.family = in_units(blocks.difference(uncertain, w));
  if (weights.size() > 0) {
    p.family_shift = p.family_members * weights;
    p.family += scatter(p.family_members, p.family_shift, weights);
  }
  for (EffectResponse& e : p.effects) {
    e.mean = ratio.asDiagonal() * e.mean;
    for (MatrixXd& c : e.covariance) c = (ratio.asDiagonal() * c * ratio.asDiagonal()).eval();
  }
  std::vector<std::string> numerical;
  for (const EffectResponse& e : p.effects)
    if (e.kind == EffectKind::numerical) numerical.push_back(e.name);
  p = p.without(numerical);
  set_unknown_sizes(p, settings);
  return p;
}

}  // namespace vielto::gap
