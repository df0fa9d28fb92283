// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/dimensionless_groups.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/mixing_numbers.h"
#include "core/par_file.h"

namespace vielto {
namespace {

std::optional<double> positive(const ParFile& file, const std::string& name) {
  if (!file.has(name)) return std::nullopt;
  const double value = file.number(name);
  if (value > 0) return value;
  for (const Parameter& p : file.all())
    if (p.name == name) throw BadInput(file.path(), p.line, name, "is not above 0", "state a positive number");
  return std::nullopt;
}

// Relative standard uncertainty, if the file states one.
std::optional<double> relative_u(const ParFile& file, const std::string& name) {
  for (const Parameter& p : file.all())
    if (const auto u = finite_number(p.u); p.name == name && u) return *u / file.number(name);
  return std::nullopt;
}

std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return std::nullopt;
  return *a / *b;
}

std::optional<double> friction(const BulkMaterial& material) {
  if (!material.friction_angle) return std::nullopt;
  return std::tan(*material.friction_angle * kPi / 180);
}

}  // namespace

const std::array<std::string, kGroupCount> kGroupNames = {
    "l", "N_C", "Fr_M", "L_d/W_kl", "D_d/d_sz", "H_d/H_kl", "alpha_kl/alpha_AoR", "mu_d/mu_sz"};

int group_of_coefficient(const std::string& coefficient) {
  if (coefficient.size() != 2 || coefficient[0] != 'B' || coefficient[1] < '1' || coefficient[1] > '8') return -1;
  return coefficient[1] - '1';
}

MixerDimensions MixerDimensions::read(const std::string& path) {
  const ParFile file = ParFile::read(path);
  const auto lever = positive(file, "powerLever");
  if (!lever) throw BadInput(path, 0, "does not state powerLever", "add the power lever L_kl of a paddle in m");
  MixerDimensions mixer;
  mixer.lever = *lever;
  mixer.drum_length = positive(file, "drumLength");
  mixer.drum_width = positive(file, "drumWidth");
  mixer.drum_height = positive(file, "drumHeight");
  mixer.paddle_width = positive(file, "paddleLength");
  mixer.paddle_height = positive(file, "paddleWidth");
  mixer.inclination = positive(file, "paddleInclination");
  mixer.paddle_count = positive(file, "paddleCount");
  return mixer;
}

BulkMaterial BulkMaterial::read(const std::string& path) {
  const ParFile file = ParFile::read(path);
  BulkMaterial material;
  material.name = std::filesystem::path(path).stem().string();
  material.provisional = file.provisional();
  material.bulk_density = positive(file, "bulkDensity");
  material.bulk_cohesion = positive(file, "bulkCohesion");
  material.diameter = positive(file, "diameter");
  material.repose_angle = positive(file, "reposeAngle");
  material.friction_angle = positive(file, "frictionAngle");
  if (const auto a = relative_u(file, "bulkDensity"), b = relative_u(file, "bulkCohesion"); a && b)
    material.ratio_u = std::hypot(*a, *b);
  return material;
}

Groups groups_of(double fill, double speed, const MixerDimensions& mixer, const BulkMaterial& material,
                 const BulkMaterial* wall) {
  Groups g;
  g[0] = fill;
  if (material.bulk_density && material.bulk_cohesion)
    g[1] = cohesion_number(mixer.lever, speed, *material.bulk_density, *material.bulk_cohesion);
  g[2] = mixing_froude_number(mixer.lever, speed);
  g[3] = ratio(mixer.drum_length, mixer.paddle_width);
  g[4] = ratio(mixer.drum_width, material.diameter);
  g[5] = ratio(mixer.drum_height, mixer.paddle_height);
  g[6] = ratio(mixer.inclination, material.repose_angle);
  if (wall) g[7] = ratio(friction(*wall), friction(material));
  return g;
}

}  // namespace vielto
