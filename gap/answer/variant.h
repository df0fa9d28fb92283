// SPDX-License-Identifier: GPL-2.0-or-later
// The runs of a proof: before, the simulation as it is; recalibrated, with the calibrated family's mean given the fit
// rows; after, with the named effects besides; placebo, with another effect instead of the named ones.
#pragma once

#include <string>

namespace vielto::gap {

enum class Variant { before, recalibrated, after, placebo };

inline std::string text_of(Variant variant) {
  switch (variant) {
    case Variant::before:
      return "before";
    case Variant::recalibrated:
      return "recalibrated";
    case Variant::after:
      return "after";
    case Variant::placebo:
      break;
  }
  return "placebo";
}

}  // namespace vielto::gap
