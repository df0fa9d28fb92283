// SPDX-License-Identifier: GPL-2.0-or-later
/* A mesh that is a body of mass M with one degree of freedom, the vertical: it moves by gravity and by the contact
   forces of the grains on it, and by nothing else. No controller.

     M dv/dt = F_z - M g - c v          F_z: force of the grains on the mesh

     fix ID all vielto/plate mesh MESHFIX mass M [damping c] [start Z]
       mesh ID      a fix mesh/surface/stress made before this fix
       mass M       kg
       damping c    N s/m, default 0; for setting the plate down gently, not for a measurement
       start Z      put the mesh so that its lowest point is at height Z, m, at rest; default: where it is

   Velocity Verlet in step with the grains; contacts see the plate's velocity. The force of the grains is the sum over
   all processors. Gravity is the value of fix gravity. Horizontal forces and moments are carried by the guide that
   leaves the plate its one freedom. A restart carries velocity and force on; the mesh keeps its place itself.
   Global vector: 1 height of the lowest point, m; 2 velocity, m/s; 3 force of the grains on the plate, upwards, N. */
#ifdef FIX_CLASS
FixStyle(vielto / plate, FixViEltoPlate)
#else
#ifndef LMP_FIX_VIELTO_PLATE_H
#define LMP_FIX_VIELTO_PLATE_H

#include <string>

#include "fix.h"

namespace LAMMPS_NS {

class FixMeshSurface;
class MeshModuleStress;

class FixViEltoPlate : public Fix {
 public:
  FixViEltoPlate(class LAMMPS*, int, char**);
  void post_create() override;
  void pre_delete(bool unfixed) override;
  int setmask() override;
  void init() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void final_integrate() override;
  double compute_vector(int) override;
  void write_restart(FILE*) override;
  void restart(char*) override;

  double height() const { return height_; }
  double velocity() const { return velocity_; }

 private:
  double lowest_point() const;
  void move(double dz);
  void kick();
  void show_velocity();

  std::string meshId_;
  double mass_ = 0, damping_ = 0;
  bool placed_ = false;  // `start` given
  double start_ = 0;
  double gravity_ = 0;
  double velocity_ = 0, force_ = 0, height_ = 0;
  FixMeshSurface* mesh_ = nullptr;
  MeshModuleStress* stress_ = nullptr;
};

}  // namespace LAMMPS_NS
#endif
#endif
