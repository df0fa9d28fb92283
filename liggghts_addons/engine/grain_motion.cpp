// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/grain_motion.h"

#include "atom.h"
#include "domain.h"

namespace LAMMPS_NS {

using vielto::GrainMotion;

namespace {

// LIGGGHTS keeps the three values of a grain after those of the one before.
GrainMotion grains_of(const Atom* atom, int count, int group) {
  GrainMotion m = GrainMotion();
  m.count = static_cast<size_t>(count);
  m.group = group;
  m.mask = atom->mask;
  m.radius = atom->radius;
  m.mass = atom->rmass;
  if (count == 0) return m;
  m.x = atom->x[0];
  m.v = atom->v[0];
  m.omega = atom->omega[0];
  m.f = atom->f[0];
  m.torque = atom->torque[0];
  return m;
}

}  // namespace

FixViEltoIntegrate::FixViEltoIntegrate(LAMMPS* lammps, int narg, char** arg)
    : FixNVESphere(lammps, narg, arg), packed_(vielto::packed_law(lammps)) {}

bool FixViEltoIntegrate::plain() const { return !packed_ || extra != 0 || useAM_ || !atom->rmass; }

GrainMotion FixViEltoIntegrate::motion() const {
  GrainMotion m = grains_of(atom, igroup == atom->firstgroup ? atom->nfirst : atom->nlocal, groupbit);
  m.half = dtf;
  m.whole = dtv;
  // moment of inertia over m R^2: of a disc, and of a sphere
  m.halfOverInertia = domain->dimension == 2 ? dtf / 0.5 : dtf / 0.4;
  return m;
}

void FixViEltoIntegrate::initial_integrate(int vflag) {
  if (plain()) return FixNVESphere::initial_integrate(vflag);
  packed_->kick_and_move(motion());
}

void FixViEltoIntegrate::final_integrate() {
  if (plain()) return FixNVESphere::final_integrate();
  packed_->kick(motion());
}

FixViEltoGravity::FixViEltoGravity(LAMMPS* lammps, int narg, char** arg)
    : FixGravity(lammps, narg, arg), packed_(vielto::packed_law(lammps)) {}

void FixViEltoGravity::post_force(int vflag) {
  owed_ = packed_ && varflag == 0 && !fm && !fix_relax && atom->rmass;
  if (!owed_) return FixGravity::post_force(vflag);
  eflag = 0;
  GrainMotion m = grains_of(atom, atom->nlocal, groupbit);
  m.acceleration[0] = xacc;
  m.acceleration[1] = yacc;
  m.acceleration[2] = zacc;
  packed_->weigh(m);
}

// Summed when somebody asks, in LIGGGHTS' order; the grains have not moved since post_force.
double FixViEltoGravity::compute_scalar() {
  if (owed_) {
    egrav = 0.0;
    for (int i = 0; i < atom->nlocal; i++) {
      const double* const x = atom->x[i];
      if (atom->mask[i] & groupbit) egrav -= atom->rmass[i] * (xacc * x[0] + yacc * x[1] + zacc * x[2]);
    }
    owed_ = false;
  }
  return FixGravity::compute_scalar();
}

}  // namespace LAMMPS_NS
