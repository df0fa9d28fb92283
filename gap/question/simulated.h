// SPDX-License-Identifier: GPL-2.0-or-later
// Purpose: what the calibrated simulation says under any conditions inside its response library, and how sure it is,
// without a run: the emulator's baseline, integrated over the calibrated family.
//
// Equation: value = exp(ln f + b), standard uncertainty of its logarithm u^2 = E + A + D (emulator, calibrated family,
// law discrepancy: table_model.h), band value exp(-1.96 u) ... value exp(1.96 u). Observables that may be 0 or
// negative: the same without logarithms. The scatter of one run is not in u (the value is the mean over seeds), nor is
// what the library's own settings leave open, such as its grain size. Units: those of the observable. Errors: BadInput
// for an observable or a condition that the library lacks.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "gap/question/inputs.h"

namespace vielto::gap {

// "emulator", "calibration", "contact law"
constexpr std::array<const char*, 3> kSimulatedParts = {"emulator", "calibration", "contact law"};

struct SimulatedValue {
  Observation row;  // conditions and observable; value and u are the family's
  double card = 0;  // at the card's parameters alone
  double low95 = 0, high95 = 0;
  std::array<double, kSimulatedParts.size()> parts{};  // u of each, in the observable's unit
};

// Every combination of the values of each condition, by the names of kConditions ("speed", "fill" ...).
// Errors: BadInput for an observable that the apparatus lacks.
std::vector<Observation> combinations(const std::string& apparatus, const std::string& observable,
                                      const std::map<std::string, std::vector<double>>& conditions);

struct SimulatedValues {
  std::vector<SimulatedValue> values;
  std::vector<std::string> outside;  // of the library's conditions, where the options allow it
  std::vector<std::string> silent;   // conditions that the library does not know
};

SimulatedValues simulated_values(const Inputs& inputs, const std::vector<Observation>& rows, EmulatorOptions options);

std::string simulated_csv(const std::vector<SimulatedValue>& values);

}  // namespace vielto::gap
