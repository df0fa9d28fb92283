// SPDX-License-Identifier: GPL-2.0-or-later
#include "script/clump.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/bad_input.h"

namespace vielto {
namespace {

const double kPi = std::acos(-1.0);
const char* const kRow = "write 'x y z r' in m, one sphere a line";

bool touch(const ClumpSphere& a, const ClumpSphere& b) {
  double square = 0;
  for (int d = 0; d < 3; d++) square += (a.x[d] - b.x[d]) * (a.x[d] - b.x[d]);
  return std::sqrt(square) < a.r + b.r;
}

bool hang_together(const std::vector<ClumpSphere>& spheres) {
  std::vector<std::size_t> reached = {0};
  std::vector<bool> seen(spheres.size(), false);
  seen[0] = true;
  for (std::size_t k = 0; k < reached.size(); k++)
    for (std::size_t j = 0; j < spheres.size(); j++)
      if (!seen[j] && touch(spheres[reached[k]], spheres[j])) seen[j] = true, reached.push_back(j);
  return reached.size() == spheres.size();
}

// Volume and its moments of first and second order: 1, x, y, z, xx, xy, xz, yy, yz, zz.
std::array<double, 10> moments(const std::vector<ClumpSphere>& spheres, int columns) {
  double low[2], step[2];
  for (int d = 0; d < 2; d++) {
    double high = -INFINITY;
    low[d] = INFINITY;
    for (const ClumpSphere& s : spheres) low[d] = std::min(low[d], s.x[d] - s.r), high = std::max(high, s.x[d] + s.r);
    step[d] = (high - low[d]) / columns;
  }
  std::array<double, 10> sum{};
  std::vector<std::pair<double, double>> pieces;  // of a column, in the spheres
  for (int i = 0; i < columns; i++)
    for (int j = 0; j < columns; j++) {
      const double x = low[0] + (i + 0.5) * step[0], y = low[1] + (j + 0.5) * step[1];
      pieces.clear();
      for (const ClumpSphere& s : spheres) {
        const double square = s.r * s.r - (x - s.x[0]) * (x - s.x[0]) - (y - s.x[1]) * (y - s.x[1]);
        if (square > 0) pieces.emplace_back(s.x[2] - std::sqrt(square), s.x[2] + std::sqrt(square));
      }
      std::sort(pieces.begin(), pieces.end());
      double top = -INFINITY;
      for (const auto& [from, to] : pieces) {
        const double a = std::max(from, top), b = std::max(to, top);
        const double z0 = b - a, z1 = (b * b - a * a) / 2, z2 = (b * b * b - a * a * a) / 3;
        if (b <= a) continue;
        const double terms[10] = {z0, x * z0, y * z0, z1, x * x * z0, x * y * z0, x * z1, y * y * z0, y * z1, z2};
        for (int k = 0; k < 10; k++) sum[static_cast<std::size_t>(k)] += terms[k] * step[0] * step[1];
        top = b;
      }
    }
  return sum;
}

}  // namespace

double Clump::diameter() const { return std::cbrt(6 * volume / kPi); }

double Clump::smallest() const {
  double r = INFINITY;
  for (const ClumpSphere& s : spheres) r = std::min(r, s.r);
  return r;
}

Clump Clump::scaled_to(double d) const {
  const double scale = d / diameter();
  Clump result = *this;
  result.volume *= scale * scale * scale;
  for (double& value : result.inertia) value *= scale * scale;
  for (ClumpSphere& s : result.spheres) {
    for (double& x : s.x) x *= scale;
    s.r *= scale;
  }
  return result;
}

Clump Clump::read(const std::string& path, int columns) {
  std::ifstream in(path);
  if (!in)
    throw BadInput(path, 0, "this clump cannot be read", "give the grain a file of spheres, or run with -var clump no");
  Clump clump;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    ClumpSphere s;
    std::string rest;
    if (!(words >> s.x[0] >> s.x[1] >> s.x[2] >> s.r) || words >> rest)
      throw BadInput(path, number, "this row is not four numbers", kRow);
    if (!(s.r > 0) || !(std::fabs(s.x[0]) + std::fabs(s.x[1]) + std::fabs(s.x[2]) + s.r < 1))
      throw BadInput(path, number, "radius <= 0, or not in metres", kRow);
    clump.spheres.push_back(s);
  }
  if (clump.spheres.size() < 2) throw BadInput(path, 0, "a clump needs two spheres at least", kRow);
  if (!hang_together(clump.spheres))
    throw BadInput(path, 0, "the spheres do not hang together", "let each overlap another one");

  const std::array<double, 10> m = moments(clump.spheres, columns);
  clump.volume = m[0];
  const double c[3] = {m[1] / m[0], m[2] / m[0], m[3] / m[0]};
  for (ClumpSphere& s : clump.spheres)
    for (int d = 0; d < 3; d++) s.x[d] -= c[d];
  const double xx = m[4] / m[0] - c[0] * c[0], xy = m[5] / m[0] - c[0] * c[1], xz = m[6] / m[0] - c[0] * c[2];
  const double yy = m[7] / m[0] - c[1] * c[1], yz = m[8] / m[0] - c[1] * c[2], zz = m[9] / m[0] - c[2] * c[2];
  clump.inertia = {yy + zz, -xy, -xz, xx + zz, -yz, xx + yy};
  return clump;
}

}  // namespace vielto
