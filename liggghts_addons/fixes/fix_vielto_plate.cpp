// SPDX-License-Identifier: GPL-2.0-or-later
#include "fixes/fix_vielto_plate.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "comm.h"
#include "error.h"
#include "fix_gravity.h"
#include "fix_mesh_surface.h"
#include "force.h"
#include "mesh_module_stress.h"
#include "modify.h"
#include "update.h"

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

typedef MultiVectorContainer<double, 3, 3> Corners;

}  // namespace

FixViEltoPlate::FixViEltoPlate(LAMMPS* lammps, int narg, char** arg) : Fix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 3;
  global_freq = 1;
  extvector = 0;
  restart_global = 1;
  for (int i = 3; i < narg; i += 2) {
    const std::string key = arg[i];
    if (i + 1 >= narg) error->fix_error(FLERR, this, ("keyword " + key + " lacks a value").c_str());
    if (key == "mesh")
      meshId_ = arg[i + 1];
    else if (key == "mass")
      mass_ = force->numeric(FLERR, arg[i + 1]);
    else if (key == "damping")
      damping_ = force->numeric(FLERR, arg[i + 1]);
    else if (key == "start")
      start_ = force->numeric(FLERR, arg[i + 1]), placed_ = true;
    else
      error->fix_error(FLERR, this, ("unknown keyword " + key).c_str());
  }
  if (!(mass_ > 0)) error->fix_error(FLERR, this, "mass M > 0 is required");
  if (!(damping_ >= 0)) error->fix_error(FLERR, this, "damping must be >= 0");
  mesh_ = dynamic_cast<FixMeshSurface*>(modify->find_fix_id(meshId_.c_str()));
  stress_ = mesh_ ? dynamic_cast<MeshModuleStress*>(mesh_->get_module("stress")) : nullptr;
  if (!stress_) error->fix_error(FLERR, this, "mesh must name a fix mesh/surface/stress made before it");
}

void FixViEltoPlate::post_create() {
  if (mesh_->triMesh()->isMoving()) error->fix_error(FLERR, this, "something else moves this mesh already");
  mesh_->triMesh()->registerMove(false, true, false);
  if (placed_ && !modify->have_restart_data(this)) move(start_ - lowest_point());
}

void FixViEltoPlate::pre_delete(bool unfixed) {
  if (!unfixed || modify->find_fix_id(meshId_.c_str()) != mesh_) return;
  mesh_->triMesh()->unregisterMove(false, true, false);
  // contacts would go on seeing the last velocity
  velocity_ = 0;
  show_velocity();
}

int FixViEltoPlate::setmask() { return INITIAL_INTEGRATE | FINAL_INTEGRATE; }

void FixViEltoPlate::init() {
  FixGravity* fix = static_cast<FixGravity*>(modify->find_fix_style("gravity", 0));
  if (!fix) error->fix_error(FLERR, this, "needs a fix gravity");
  double g[3];
  fix->get_gravity(g);
  if (g[0] != 0 || g[1] != 0) error->fix_error(FLERR, this, "needs a vertical fix gravity");
  gravity_ = g[2];
}

void FixViEltoPlate::setup(int) {
  if (!mesh_->triMesh()->prop().getElementProperty<Corners>("v"))
    mesh_->triMesh()->prop().addElementProperty<Corners>("v", "comm_exchange_borders", "frame_invariant", "restart_no");
  show_velocity();
  height_ = lowest_point();
}

double FixViEltoPlate::lowest_point() const {
  TriMesh* mesh = mesh_->triMesh();
  double mine = std::numeric_limits<double>::infinity(), lowest = 0;
  for (int i = 0; i < mesh->sizeLocal(); i++)
    for (int k = 0; k < 3; k++) {
      double node[3];
      mesh->node(i, k, node);
      mine = std::min(mine, node[2]);
    }
  MPI_Allreduce(&mine, &lowest, 1, MPI_DOUBLE, MPI_MIN, world);
  return lowest;
}

void FixViEltoPlate::move(double dz) {
  const double step[3] = {0, 0, dz};
  mesh_->triMesh()->move(step);
  height_ += dz;
}

// Half a step of the velocity under constant force; with the damper exactly, so that any c is stable.
void FixViEltoPlate::kick() {
  const double half = 0.5 * update->dt, acceleration = force_ / mass_ + gravity_;
  const double rate = damping_ / mass_;
  velocity_ += rate > 0 ? -std::expm1(-rate * half) * (acceleration / rate - velocity_) : half * acceleration;
}

void FixViEltoPlate::show_velocity() {
  Corners* v = mesh_->triMesh()->prop().getElementProperty<Corners>("v");
  if (!v) return;
  double now[3] = {0, 0, velocity_};
  for (int i = 0; i < mesh_->triMesh()->size(); i++)
    for (int k = 0; k < 3; k++) v->set(i, k, now);
}

void FixViEltoPlate::initial_integrate(int) {
  kick();
  move(velocity_ * update->dt);
  show_velocity();
}

// The mesh fix, made before this one, has just summed its force over all processors.
void FixViEltoPlate::final_integrate() {
  force_ = stress_->f_total(2);
  kick();
}

double FixViEltoPlate::compute_vector(int n) {
  const double values[3] = {height_, velocity_, force_};
  return values[n];
}

void FixViEltoPlate::write_restart(FILE* fp) {
  const double list[] = {velocity_, force_};
  if (comm->me != 0) return;
  const int size = static_cast<int>(sizeof list);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(list, sizeof list, 1, fp);
}

void FixViEltoPlate::restart(char* buf) {
  const double* list = reinterpret_cast<const double*>(buf);
  velocity_ = list[0];
  force_ = list[1];
}
