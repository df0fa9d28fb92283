// SPDX-License-Identifier: GPL-2.0-or-later
/* Makes a LIGGGHTS that was built without ViElTo understand it, without touching it: contact models and their
   combinations enter LIGGGHTS' own registries when the shared library is loaded; fix styles and the script command
   enter a simulation's tables when install() is called for it (by our executable at the start, and by every ViElTo
   pair_style or wall, which is how the stock executable gets them). */
#ifndef VIELTO_REGISTER_H
#define VIELTO_REGISTER_H

namespace LAMMPS_NS {
class LAMMPS;
}

namespace vielto {

// Adds the fixes vielto/... and the command vielto to this simulation; harmless if they are there.
void install(LAMMPS_NS::LAMMPS* lmp);

}  // namespace vielto

#endif
