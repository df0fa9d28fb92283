// SPDX-License-Identifier: GPL-2.0-or-later
// The options that name materials: --material CARD (repeatable), or --bulk-density and --bulk-cohesion for one without
// a card.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/data_folder.h"
#include "equation/dimensionless_groups.h"

namespace vielto {

struct MaterialOptions {
  std::vector<std::string> cards;
  double bulk_density = 0, bulk_cohesion = 0;

  void add_to(CLI::App* command) {
    CLI::Option* card = command->add_option(
        "--material", cards,
        "material card of grain or wall: NAME.par, or NAME of one that came with vielto (repeatable)");
    CLI::Option* density =
        command->add_option("--bulk-density", bulk_density, "kg/m3, of the one material, without a card");
    CLI::Option* cohesion =
        command->add_option("--bulk-cohesion", bulk_cohesion, "Pa, of the one material, without a card");
    density->check(CLI::PositiveNumber)->needs(cohesion)->excludes(card);
    cohesion->check(CLI::PositiveNumber)->needs(density)->excludes(card);
  }

  std::vector<BulkMaterial> read() const {
    if (cards.empty() && bulk_density == 0)
      throw CLI::RequiredError("--material CARD, or --bulk-density and --bulk-cohesion,");
    std::vector<BulkMaterial> materials;
    for (const std::string& card : cards) materials.push_back(BulkMaterial::read(named_in("materials", card, ".par")));
    if (cards.empty()) {
      BulkMaterial material;
      material.bulk_density = bulk_density;
      material.bulk_cohesion = bulk_cohesion;
      materials.push_back(material);
    }
    return materials;
  }
};

}  // namespace vielto
