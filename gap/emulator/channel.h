// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: one observable of one apparatus as the library shows it, smoothed over conditions (gaussian_process.h): the
// baseline's mean over its seeds, the logarithm of the seed variance, the response to each effect and to the calibrated
// parameters.
//
// An observable whose every run is above 0 is smoothed in its logarithm (`relative`), so that effects multiply; others,
// and rows of the bench that an effect adds to (the gap under a paddle), as they are. Conditions are the numeric ones
// that vary in the library, as logarithms where all are above 0, in units of their range: 0 at the least, 1 at the
// largest.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/condition.h"
#include "gap/emulator/gaussian_process.h"
#include "gap/library/effect.h"
#include "gap/library/library.h"

namespace vielto::gap {

struct Smooth {
  GaussianProcess process;
  std::vector<Point> points;
  Eigen::MatrixXd noise;
};

// Runs at the same point.
struct Mean {
  Point point;
  std::vector<double> values;
  double mean() const;
};
using Means = std::map<std::string, Mean>;

void add_to(Means& means, const Point& point, double value);
std::vector<Point> points_of(const Means& means);

// Calibrated parameters count in units of the spread of the runs that vary them.
struct ParameterScale {
  Eigen::VectorXd nominal, spread;
  explicit ParameterScale(const Library& library);
  ParameterScale() = default;
  Eigen::VectorXd in_units(const Eigen::VectorXd& parameters) const;
};

struct Channel {
  std::string apparatus, observable;
  bool relative = false;
  double size = 0;  // root mean square of the baseline
  std::vector<NamedCondition> varying;
  std::vector<double> low, high;
  std::vector<bool> logarithmic;
  Observation sample;  // the conditions that do not vary
  std::set<std::string> walls, materials;
  Smooth level;
  std::optional<Smooth> log_seed_variance;  // none: no noise (bench)
  std::map<std::string, Smooth> responses;
  std::optional<Smooth> parameters;

  double coordinate(std::size_t k, double value) const;
  Point point(const Observation& row) const;
  double value(double smoothed) const;
  double smoothed(double value) const;
};

// The channel of `values`, all of one apparatus and observable. Errors: BadInput where some runs state a condition and
// others do not.
Channel make_channel(const Library& library, const std::vector<const LibraryValue*>& values,
                     const std::vector<Effect>& effects, const ParameterScale& scale);

double largest_strength(const Effect& effect);

}  // namespace vielto::gap
