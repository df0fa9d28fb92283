// SPDX-License-Identifier: GPL-2.0-or-later
/* What the adapters of one simulation share: the settings chosen on the pair_style line, and the tally that
   `fix vielto/record` reads (overlaps, energies). One LAMMPS object per process, as LIGGGHTS' own globals. */
#ifndef VIELTO_STATE_H
#define VIELTO_STATE_H

namespace vielto {

struct Settings {
  double springFactor;      // c_n
  double wallRadiusFactor;  // R_2/R_1 of a wall
  int law;                  // LIGGGHTS' id of the last pair_style's normal model; 0: none of this package
  double maxOverlap;        // over the diameter; 0: no limit
};

/* Sums since the fix last cleared them; energies in J, positive where energy leaves the grains.
   Pairs across two processors are evaluated by both and count half on each. */
struct Tally {
  bool overlaps;      // measure the mean overlap in this step
  bool energy;        // keep the energy accounts
  double contacts;    // contacts measured
  double overlapSum;  // of overlap over diameter of the smaller grain
  double overlapMax;  // of the same; kept in every step
  double wallForce;   // greatest normal force on a wall in this step, N, and the grain it acts on
  int wallGrain;
  double elastic;  // energy stored in all springs in this step
  double normalDamping;
  double tangentialDamping;
  double sliding;
  double rolling;
  double twisting;
};

// What the models of one pair_style or wall were set to; each adds its own (`describe`).
struct LawSettings {
  double springFactor, wallRadiusFactor, wallRolling;
  double adhesion;  // over both diameters, Pa; 0: none
  bool limitForce, slidingDashpot, radiusLever, rolling, rollingDashpot;
  int slidingAt, rollingAt;  // places in the contact's history
};

inline Settings& settings() {
  static Settings s = {4.0, 2.0, 0, 0.0};
  return s;
}

inline Tally& tally() {
  static Tally t = {};
  return t;
}

// What this processor counts of a contact: half where the pair is evaluated on two processors.
template <class ContactData>
inline double share(const ContactData& sidata, int nlocal, int newton_pair) {
  return (sidata.is_wall || newton_pair || sidata.j < nlocal) ? 1.0 : 0.5;
}

}  // namespace vielto

#endif
