// SPDX-License-Identifier: GPL-2.0-or-later
/* The cards' values, which are ViElTo's, in the terms of other laws: what several laws' descriptions share. */
#ifndef VIELTO_CARD_MAPPING_H
#define VIELTO_CARD_MAPPING_H

#include <string>
#include <vector>

#include "engine/law.h"

namespace vielto {

// ViElTo's own properties and its adhesion, taken from the cards as they stand.
std::vector<LawProperty> vielto_properties_of_cards();

// Restitution of ViElTo's dashpot as a property of a law without one: adds the steps, the property and the refusal.
void map_restitution(Law& law);

// Of `tangential history rolling_friction epsd2`: the same greatest friction and the same greatest rolling moment.
void map_stock_friction(Law& law);

// What LIGGGHTS' own laws with those partners have no counterpart of, and where they differ beyond that.
void lacks_of_stock(Law& law);

}  // namespace vielto

#endif
