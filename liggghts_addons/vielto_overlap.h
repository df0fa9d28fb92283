// SPDX-License-Identifier: GPL-2.0-or-later
/* What an adapter tells of a contact's overlap and normal force: the tally's greatest and mean overlap, the grain
   pressed hardest against a wall, and a stop at the overlap limit that names grains, place and step. Overlaps are
   measured against the diameter of the smaller grain. */
#ifndef VIELTO_OVERLAP_H
#define VIELTO_OVERLAP_H

#include <stdio.h>

#include "atom.h"
#include "contact_interface.h"
#include "fix_mesh_surface.h"
#include "force.h"
#include "modify.h"
#include "tri_mesh.h"
#include "update.h"
#include "vielto_state.h"
#include "vielto_stop.h"

namespace vielto {

template <class ContactData>
inline double smaller_diameter(const ContactData& sidata) {
  return 2 * (sidata.is_wall || sidata.radi < sidata.radj ? sidata.radi : sidata.radj);
}

struct OverlapWatch {
  double limit;  // greatest overlap allowed, 1; 0: none

  OverlapWatch() : limit(0.0) {}

  // Called by postSettings. Over 1 no overlap can be: a percentage would be no limit at all.
  void check_limit(LAMMPS_NS::LAMMPS* lmp) const {
    if (!(limit >= 0 && limit <= 1))
      stop_all(lmp, "vielto: maxOverlap must be from 0 (no limit) to 1: it is a part of the grain's diameter");
  }

  // sidata.Fn is the normal force, sidata.deltan the overlap
  void note(LAMMPS_NS::LAMMPS* lmp, const LIGGGHTS::ContactModels::SurfacesIntersectData& sidata,
            double diameter) const {
    Tally& t = tally();
    if (sidata.deltan > t.overlapMax * diameter) {
      t.overlapMax = sidata.deltan / diameter;
      if (limit > 0 && t.overlapMax > limit) stop(lmp, sidata);
    }
    if (sidata.is_wall && sidata.Fn > t.wallForce) {
      t.wallForce = sidata.Fn;
      t.wallGrain = lmp->atom->tag[sidata.i];
    }
    if (t.overlaps) {
      const double part = share(sidata, lmp->atom->nlocal, lmp->force->newton_pair);
      t.contacts += part;
      t.overlapSum += part * sidata.deltan / diameter;
    }
  }

 private:
  void stop(LAMMPS_NS::LAMMPS* lmp, const LIGGGHTS::ContactModels::SurfacesIntersectData& sidata) const {
    char partner[200];
    if (!sidata.is_wall)
      snprintf(partner, sizeof partner, "grain %d", lmp->atom->tag[sidata.j]);
    else if (sidata.fix_mesh)
      snprintf(partner, sizeof partner, "triangle %d of mesh %s", sidata.mesh->id(sidata.j), sidata.fix_mesh->id);
    else
      snprintf(partner, sizeof partner, "a primitive wall");
    const double* x = lmp->atom->x[sidata.i];
    // of a clump that leaves the box, LIGGGHTS gives up the body and keeps the other spheres, which overlap
    const char* const clumps = lmp->modify->n_fixes_style("multisphere") > 0 ? "a clump has left the box, or " : "";
    char line[600];
    snprintf(
        line, sizeof line,
        "vielto: step " BIGINT_FORMAT
        ": overlap of grain %d at (%.4g %.4g %.4g) m with %s is %.3g %% of the diameter, "
        "over the limit of %.3g %% (maxOverlap); %sthe grain is wedged or too soft: raise youngsModulus, or look at "
        "this place",
        lmp->update->ntimestep, lmp->atom->tag[sidata.i], x[0], x[1], x[2], partner, 100 * tally().overlapMax,
        100 * limit, clumps);
    stop_here(lmp, line);
  }
};

}  // namespace vielto

#endif
