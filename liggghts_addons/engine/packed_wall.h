// SPDX-License-Identifier: GPL-2.0-or-later
// What the wall loop asks of a wall whose law packs (packed_law.h); walls of other laws are none.
#ifndef VIELTO_PACKED_WALL_H
#define VIELTO_PACKED_WALL_H

#include "contact_interface.h"
#include "engine/packed_law.h"

namespace vielto {

class PackedWall {
 public:
  virtual ~PackedWall() = default;
  virtual PackedStep packed_step() const = 0;
  // of two types in the table of mixed constants
  virtual int place(int itype, int jtype) const = 0;
  // overlap limit and statistics
  virtual void watch(const LIGGGHTS::ContactModels::SurfacesIntersectData& contact, double diameter) = 0;
};

}  // namespace vielto

#endif
