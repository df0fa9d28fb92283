// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/mesh_motion.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <string>
#include <typeinfo>
#include <vector>

#include "comm.h"
#include "engine/private_access.h"
#include "mesh_module_stress.h"
#include "mesh_mover_rotation.h"
#include "mpi_liggghts.h"
#include "neighbor.h"
#include "output.h"
#include "tri_mesh.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace vielto {
namespace {

typedef MultiVectorContainer<double, 3, 3> Corners;
typedef VectorContainer<double, 3> Vectors;

struct MoverOf {
  typedef MeshMover* FixMoveMesh::*type;
};
struct TimeOf {
  typedef double FixMoveMesh::*type;
};
struct TimeSinceSetupOf {
  typedef double FixMoveMesh::*type;
};
struct AxisOf {
  typedef double (MeshMoverRotate::*type)[3];
};
struct PointOf {
  typedef double (MeshMoverRotate::*type)[3];
};
struct RateOf {
  typedef double MeshMoverRotate::*type;
};
struct MoversOf {
  typedef std::list<FixMoveMesh*> FixMesh::*type;
};
struct ExchangedOf {
  typedef bool FixMesh::*type;
};
struct ModulesOf {
  typedef std::vector<std::string> FixMeshSurface::*type;
};
struct SummedOf {
  typedef bool MeshModuleStress::*type;
};
struct NodesOf {
  typedef Corners MultiNodeMesh<3>::*type;
};
struct NodesThenOf {
  typedef Corners MultiNodeMesh<3>::*type;
};
struct CentresOf {
  typedef Vectors MultiNodeMesh<3>::*type;
};
struct BoundsOf {
  typedef BoundingBox MultiNodeMesh<3>::*type;
};
struct OfElementsOf {
  typedef AssociativePointerArray<ContainerBase> CustomValueTracker::*type;
};
struct OfMeshOf {
  typedef AssociativePointerArray<ContainerBase> CustomValueTracker::*type;
};
struct StandsOf {
  typedef bool (ContainerBase::*type)() const;
};

template <class Key, class Object>
auto& opened(Object& object) {
  return object.*Handed<Key>::pointer;
}

}  // namespace

template struct Opened<MoverOf, &FixMoveMesh::move_>;
template struct Opened<TimeOf, &FixMoveMesh::time_>;
template struct Opened<TimeSinceSetupOf, &FixMoveMesh::time_since_setup_>;
template struct Opened<AxisOf, &MeshMoverRotate::axis_>;
template struct Opened<PointOf, &MeshMoverRotate::point_>;
template struct Opened<RateOf, &MeshMoverRotate::omega_>;
template struct Opened<MoversOf, &FixMesh::fixMoveMeshes_>;
template struct Opened<ExchangedOf, &FixMesh::pOpFlag_>;
template struct Opened<ModulesOf, &FixMeshSurface::mesh_module_order>;
template struct Opened<SummedOf, &MeshModuleStress::updatedStresses_>;
template struct Opened<NodesOf, &MultiNodeMesh<3>::node_>;
template struct Opened<NodesThenOf, &MultiNodeMesh<3>::nodesLastRe_>;
template struct Opened<CentresOf, &MultiNodeMesh<3>::center_>;
template struct Opened<BoundsOf, &MultiNodeMesh<3>::bbox_>;
template struct Opened<OfElementsOf, &CustomValueTracker::elementProperties_>;
template struct Opened<OfMeshOf, &CustomValueTracker::globalProperties_>;
template struct Opened<StandsOf, &ContainerBase::isRotationInvariant>;

}  // namespace vielto

namespace LAMMPS_NS {

using namespace vielto;

namespace {

// LIGGGHTS keeps the numbers of a container one after the other.
template <int N>
double* numbers(MultiVectorContainer<double, N, 3>& c) {
  return c.size() > 0 ? c.begin()[0][0] : nullptr;
}
double* numbers(Vectors& c) { return c.size() > 0 ? c.begin()[0] : nullptr; }

}  // namespace

FixViEltoMoveMesh::FixViEltoMoveMesh(LAMMPS* lammps, int narg, char** arg)
    : FixMoveMesh(lammps, narg, arg), packed_(packed_law(lammps)) {}

void FixViEltoMoveMesh::setup(int vflag) {
  FixMoveMesh::setup(vflag);
  quick_ = packed_ && turns_only();
  dt_ = 0;
  edges_.clear();
  normals_.clear();
  if (!quick_) return;
  velocities_ = mesh()->prop().getElementProperty<Corners>("v");
  const auto& properties = opened<OfElementsOf>(mesh()->prop());
  for (int k = 0; k < properties.size(); k++) {
    ContainerBase* const one = properties.getBasePointerByIndex(k);
    if ((one->*Handed<StandsOf>::pointer)()) continue;
    Corners* const three = dynamic_cast<Corners*>(one);
    Vectors* const single = dynamic_cast<Vectors*>(one);
    if (three) edges_.push_back(three);
    if (single) normals_.push_back(single);
    if (!three && !single) quick_ = false;
  }
}

bool FixViEltoMoveMesh::turns_only() {
  MeshMover* const mover = opened<MoverOf>(*static_cast<FixMoveMesh*>(this));
  TriMesh* const own = dynamic_cast<TriMesh*>(mesh());
  if (!own || typeid(*own) != typeid(TriMesh) || typeid(*mover) != typeid(MeshMoverRotate)) return false;
  double point[3];
  mover->get_reference_point(point);
  return mover->isFirst() && opened<MoversOf>(*fixMesh()).size() == 1 && !own->is_set_store_omega() &&
         vectorMag3DSquared(point) == 0;
}

// As in MultiNodeMesh::rotate and MeshMoverRotate::initial_integrate.
void FixViEltoMoveMesh::quaternion(double dt) {
  if (dt == dt_) return;
  dt_ = dt;
  MeshMoverRotate& mover = *static_cast<MeshMoverRotate*>(opened<MoverOf>(*static_cast<FixMoveMesh*>(this)));
  const double* const along = opened<AxisOf>(mover);
  const double rate = opened<RateOf>(mover), angle = rate * dt;
  double axis[3];
  vectorCopy3D(along, axis);
  vectorScalarDiv3D(axis, vectorMag3D(axis));
  quaternion_[0] = cos(angle * 0.5);
  for (int d = 0; d < 3; d++) quaternion_[d + 1] = axis[d] * sin(angle * 0.5);
  vectorScalarMult3D(along, rate, spin_);
}

void FixViEltoMoveMesh::initial_integrate(int vflag) {
  if (!quick_) return FixMoveMesh::initial_integrate(vflag);
  FixMoveMesh& base = *this;
  opened<TimeOf>(base) += update->dt;
  opened<TimeSinceSetupOf>(base) += update->dt;
  quaternion(update->dt);
  TriMesh* const own = static_cast<TriMesh*>(mesh());
  Corners& nodes = opened<NodesOf>(*static_cast<MultiNodeMesh<3>*>(own));
  const MeshMotion& motion = packed_->mesh;
  motion.turn(numbers(nodes), 3 * nodes.size(), quaternion_);
  for (Corners* one : edges_) motion.turn(numbers(*one), 3 * one->size(), quaternion_);
  for (Vectors* one : normals_) motion.turn(numbers(*one), one->size(), quaternion_);
  opened<OfMeshOf>(own->prop()).rotate(quaternion_);
  motion.swing(numbers(nodes), 3 * nodes.size(), spin_, numbers(*velocities_));
  centres(own);
  bounds(own);
}

void FixViEltoMoveMesh::centres(TriMesh* own) const {
  MultiNodeMesh<3>& mesh = *own;
  const double* node = numbers(opened<NodesOf>(mesh));
  double* centre = numbers(opened<CentresOf>(mesh));
  for (int t = 0; t < own->size(); t++, node += 9, centre += 3)
    for (int d = 0; d < 3; d++) centre[d] = 1. / 3. * (node[d + 6] + (node[d + 3] + (node[d] + 0.)));
}

void FixViEltoMoveMesh::bounds(TriMesh* own) const {
  MultiNodeMesh<3>& mesh = *own;
  const double* const node = numbers(opened<NodesOf>(mesh));
  const int count = 3 * own->sizeLocal();
  BoundingBox& box = opened<BoundsOf>(mesh);
  box.reset();
  if (count > 0) {
    double low[3], high[3];
    for (int d = 0; d < 3; d++) low[d] = high[d] = node[d];
    for (int k = 1; k < count; k++)
      for (int d = 0; d < 3; d++) {
        low[d] = std::min(low[d], node[3 * k + d]);
        high[d] = std::max(high[d], node[3 * k + d]);
      }
    box.extendToContain(low);
    box.extendToContain(high);
  }
  if (comm->nprocs > 1) box.extendToParallel(world);
}

FixViEltoMesh::FixViEltoMesh(LAMMPS* lammps, int narg, char** arg)
    : FixMeshSurface(lammps, narg, arg), packed_(packed_law(lammps)) {}

int FixViEltoMesh::setmask() { return FixMeshSurface::setmask() | FixConst::POST_RUN; }

void FixViEltoMesh::setup(int vflag) {
  FixMeshSurface::setup(vflag);
  stress_ = dynamic_cast<MeshModuleStress*>(get_module("stress"));
  quick_ = packed_ && stress_only();
  owed_ = false;
}

bool FixViEltoMesh::stress_only() {
  TriMesh* const own = triMesh();
  return stress_ && typeid(*own) == typeid(TriMesh) && stress_->trackStress() && !stress_->trackWear() &&
         opened<ModulesOf>(*static_cast<FixMeshSurface*>(this)).size() == 1 && !surfaceVel() &&
         !trackPerElementTemp() && !(mass_temperature_ > 0);
}

// As in MultiNodeMesh::decideRebuild.
bool FixViEltoMesh::must_rebuild() const {
  MultiNodeMesh<3>& mesh = *const_cast<FixViEltoMesh*>(this)->triMesh();
  if (!mesh.isMoving()) return false;
  const int local = mesh.sizeLocal();
  Corners &now = opened<NodesOf>(mesh), &then = opened<NodesThenOf>(mesh);
  int far = packed_->mesh.farthest(numbers(now), numbers(then), 3 * local) > 0.25 * neighbor->skin * neighbor->skin;
  if (comm->nprocs > 1) MPI_Max_Scalar(far, world);
  return far != 0;
}

void FixViEltoMesh::pre_force(int vflag) {
  if (!quick_ || opened<ExchangedOf>(*static_cast<FixMesh*>(this))) return FixMeshSurface::pre_force(vflag);
  mesh()->forwardComm();
  if (must_rebuild()) next_reneighbor = update->ntimestep + 1;
  mesh()->clearReverse();
  stress_->pre_force(vflag);
}

// Forces on the whole mesh in each step, those on its triangles (and ghosts' handed back) where they are read.
void FixViEltoMesh::final_integrate() {
  owed_ = quick_ && update->ntimestep != output->next;
  if (!owed_) return FixMeshSurface::final_integrate();
  if (comm->nprocs > 1) {
    MPI_Sum_Vector(stress_->f_total_ptr(), 3, world);
    MPI_Sum_Vector(stress_->torque_total_ptr(), 3, world);
  }
  opened<SummedOf>(*stress_) = true;
}

// A run that was ended between two outputs may be followed by a write_dump.
void FixViEltoMesh::post_run() {
  FixMeshSurface::post_run();
  if (!owed_) return;
  double sum[3], moment[3];
  stress_->f_total(sum);
  stress_->torque_total(moment);
  FixMeshSurface::final_integrate();
  // the sums over the ranks were made before
  vectorCopy3D(sum, stress_->f_total_ptr());
  vectorCopy3D(moment, stress_->torque_total_ptr());
  owed_ = false;
}

}  // namespace LAMMPS_NS
