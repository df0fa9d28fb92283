// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/whole_shaft.h"

#include <cmath>
#include <numeric>

#include "core/mixing_numbers.h"

namespace vielto {
namespace {

using Curve = std::vector<double>;

void add(Curve& sum, double factor, const Curve& curve) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * curve[i];
}

Curve scaled(double factor, Curve curve) {
  for (double& value : curve) value *= factor;
  return curve;
}

// One paddle's torque against its own angle, the mean of the slice's paddles.
Curve single_paddle(const TorqueRecord& record, int first, int count) {
  Curve mean(kPhases, 0.0);
  for (std::size_t j = 0; j < record.paddle.size(); ++j)
    add(mean, 1.0 / static_cast<double>(record.paddle.size()),
        turned(phase_mean(record.paddle[j], first, count), -record.header.paddle_angles[j]));
  return mean;
}

Curve all_paddles(const TorqueRecord& record, const Curve& paddle, int first, int count) {
  if (record.header.slice == 0) return phase_mean(record.part[0], first, count);
  Curve sum(kPhases, 0.0);
  for (int i = 0; i < record.header.paddles; ++i) add(sum, 1, turned(paddle, i * record.header.paddle_angle_step));
  return sum;
}

Curve rotor_curve(const TorqueRecord& record, int first, int count) {
  Curve rotor = all_paddles(record, single_paddle(record, first, count), first, count);
  for (std::size_t p = 1; p < record.parts.size(); ++p)
    if (record.parts[p].turns) add(rotor, record.header.whole_drum(), phase_mean(record.part[p], first, count));
  return rotor;
}

double ripple(const Curve& curve) {
  const double n = static_cast<double>(curve.size());
  const double mean = std::accumulate(curve.begin(), curve.end(), 0.0) / n;
  double squares = 0;
  for (const double value : curve) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / n) / std::fabs(mean);
}

}  // namespace

std::vector<double> turned(const std::vector<double>& curve, double angle) {
  const auto n = static_cast<long>(curve.size());
  const double shift = angle / (2 * kPi) * static_cast<double>(n);
  double whole = std::floor(shift);
  double part = shift - whole;
  // A shift by whole phases must not smear, whatever the rounding of degrees to radians and back.
  if (part > 1 - 1e-9) whole += 1, part = 0;
  if (part < 1e-9) part = 0;
  const long steps = ((static_cast<long>(whole) % n) + n) % n;
  std::vector<double> result(curve.size());
  for (long i = 0; i < n; ++i) result[i] = (1 - part) * curve[(i + steps) % n] + part * curve[(i + steps + 1) % n];
  return result;
}

std::vector<double> phase_mean(const std::vector<double>& signal, int first, int count) {
  std::vector<double> mean(kPhases, 0.0);
  for (int i = first; i < first + count * kPhases; ++i) mean[i % kPhases] += signal[i] / count;
  return mean;
}

namespace {

// Mean of n curves without one of them.
Curve left_out(const Curve& mean, const Curve& one, double n) {
  Curve rest = scaled(n / (n - 1), mean);
  add(rest, -1 / (n - 1), one);
  return rest;
}

// Standard uncertainty from the values with one turn left out at a time.
double jackknife(const std::vector<double>& without) {
  const double n = static_cast<double>(without.size());
  const double mean = std::accumulate(without.begin(), without.end(), 0.0) / n;
  double squares = 0;
  for (const double r : without) squares += (r - mean) * (r - mean);
  return std::sqrt((n - 1) / n * squares);
}

std::array<double, kPaddleShares.size()> shares_of(const Curve& paddle) {
  std::array<double, kSectors> sectors{};
  for (std::size_t i = 0; i < paddle.size(); ++i)
    sectors[sector_of(360.0 / kPhases * (static_cast<double>(i) + 0.5))] += paddle[i];
  const double all = std::accumulate(sectors.begin(), sectors.end(), 0.0);
  std::array<double, kPaddleShares.size()> shares{};
  for (std::size_t k = 0; k < shares.size() && all != 0; ++k) shares[k] = sectors[kPaddleShares[k].sector] / all;
  return shares;
}

void add_shares(const TorqueRecord& record, int first, int count, ShaftCurves& curves) {
  if (curves.paddle.empty()) return;
  curves.shares = shares_of(curves.paddle);
  std::array<std::vector<double>, kPaddleShares.size()> without;
  for (int t = 0; t < count; ++t) {
    const auto shares = shares_of(left_out(curves.paddle, single_paddle(record, first + t * kPhases, 1), count));
    for (std::size_t k = 0; k < shares.size(); ++k) without[k].push_back(shares[k]);
  }
  for (std::size_t k = 0; k < without.size(); ++k) curves.shares_u[k] = jackknife(without[k]);
}

}  // namespace

ShaftCurves shaft_curves(const TorqueRecord& record, int first, int count) {
  ShaftCurves curves;
  const double scale = record.header.whole_drum();
  if (record.header.slice > 0) curves.paddle = single_paddle(record, first, count);
  curves.part.push_back(all_paddles(record, curves.paddle, first, count));
  for (std::size_t p = 1; p < record.parts.size(); ++p)
    curves.part.push_back(scaled(scale, phase_mean(record.part[p], first, count)));
  curves.rotor = rotor_curve(record, first, count);
  curves.ripple = ripple(curves.rotor);

  // T of each turn alone: their mean is T, as everything above is linear.
  const double n = count;
  std::vector<Curve> turns;
  for (int t = 0; t < count; ++t) turns.push_back(rotor_curve(record, first + t * kPhases, 1));
  curves.rotor_u.assign(kPhases, 0.0);
  for (int i = 0; i < kPhases; ++i) {
    double squares = 0;
    for (const Curve& turn : turns) squares += (turn[i] - curves.rotor[i]) * (turn[i] - curves.rotor[i]);
    curves.rotor_u[i] = std::sqrt(squares / (n - 1) / n);
  }
  std::vector<double> without;  // ripple with one turn left out
  for (const Curve& turn : turns) without.push_back(ripple(left_out(curves.rotor, turn, n)));
  curves.ripple_u = jackknife(without);
  add_shares(record, first, count, curves);
  double noise = 0;
  for (const double u : curves.rotor_u) noise += u * u / kPhases;
  const double torque = std::accumulate(curves.rotor.begin(), curves.rotor.end(), 0.0) / kPhases;
  curves.ripple_noise = std::sqrt(noise) / std::fabs(torque);
  return curves;
}

}  // namespace vielto
