// SPDX-License-Identifier: GPL-2.0-or-later
/* ViElTo evaluated for several contacts at once in vector registers.

   Purpose   The same numbers, to the last bit, as the adapters (normal_model_vielto.h and its fellows) give contact by
             contact, in less time. A loop fills a block with its contacts, side by side; one call evaluates the block;
             the loop adds its forces to the grains in the order of the contacts.
   Choice    packed_law() takes the widest registers that the processor has: 8 contacts at once with AVX-512, 4 with
             AVX2. The environment variable VIELTO_LANES sets it (1: contact by contact, the reference). */
#ifndef VIELTO_PACKED_LAW_H
#define VIELTO_PACKED_LAW_H

#include "engine/near_search.h"
#include "engine/pair_list.h"
#include "vielto_law.h"
#include "vielto_state.h"

namespace LAMMPS_NS {
class LAMMPS;
}

namespace vielto {

// Contacts 0 ... count-1; vectors by component, then by contact. SI units; body 2 is grain j or the wall.
struct alignas(64) Block {
  static constexpr int size = 32;
  typedef double Row[size];

  Row delta[3];  // x_1 - x_2, or from the nearest point of a wall to x_1
  Row square;    // |delta|^2, of pairs
  Row gap;       // overlap, of walls, as the mesh tells it
  Row R1, R2;    // R2: pairs only
  Row m1, m2;    // m2: pairs only
  Row v[3];      // v_1 - v_2
  Row spin1[3], spin2[3];
  int pair[size];  // of the types in the table of mixed constants
  // history before, and after
  Row sliding[3];  // F_s
  Row rolling[3];  // M_r
  Row twisting;    // M_tw
  // results
  Row force[3];                   // on body 1; body 2 gets the opposite
  Row torque1[3];                 // on body 1
  Row torque2[3];                 // on body 2; of a wall the rolling and twisting couple only
  Row overlap, normal;            // u_n, F_n
  bool alike;                     // every contact has the pair of the first
  bool held1[size], held2[size];  // in the group of fix freeze
};

struct PackedStep {
  LawSettings settings;
  const Pair* pairs;  // table of mixed constants
  double dt;
  double greatestOverlap;  // over the smaller diameter, so far
  bool frozen;             // held1 and held2 count
};

// The grains of pairs as LIGGGHTS holds them: vectors are three values a grain, one grain after the other.
struct PackedGrains {
  const Place* places;
  const double *v, *omega;
  const double *mass, *body;  // body: mass of the clump that a grain belongs to, if > 0; NULL: there are none
  const int *type, *mask;
  int types;   // a pair stands at types * type_i + type_j
  int frozen;  // bit of the group of fix freeze
  int owned;   // grains that get forces
  int flags;   // what a contact sets
  double *f, *torque;
};

// Grains to be moved by a step: `count` from the first, those of the group.
struct GrainMotion {
  size_t count;
  int group;
  const int* mask;
  const double *radius, *mass, *torque;
  double *x, *v, *omega, *f;
  double half, whole, halfOverInertia;  // of a time step, s; half over the moment of inertia over m R^2
  double acceleration[3];
};

// Vectors, three values each, one after the other; as LIGGGHTS moves the meshes, to the last bit.
struct MeshMotion {
  void (*turn)(double* vectors, size_t count, const double* quaternion);
  // Velocities of points that turn about the origin.
  void (*swing)(const double* points, size_t count, const double* spin, double* velocities);
  // Greatest square of a distance gone, m2.
  double (*farthest)(const double* now, const double* then, size_t count);
};

/* `touching`: numbers of the pairs of the block. A law returns whether some overlap may exceed greatestOverlap. `add`
   adds in the order of the contacts, so that sums are rounded as if they came one by one. */
struct PackedLaw {
  bool (*pairs)(const PackedStep&, const PackedGrains&, const NearPair*, const size_t* touching, int count, Block&);
  void (*add)(const PackedStep&, const PackedGrains&, const NearPair*, const size_t* touching, int count, const Block&);
  bool (*walls)(const PackedStep&, Block&, int count);
  NearSearch search;
  /* Of grains `from` to `to`, before it, those that are neighbours and have a greater number; `out` has room for all of
     them and a register more. Tells how many. */
  size_t (*neighbours)(const BinnedGrains&, const GrainToPair&, size_t from, size_t to, double* out);
  void (*kick_and_move)(const GrainMotion&);  // first half step of fix nve/sphere
  void (*kick)(const GrainMotion&);           // its second half
  void (*weigh)(const GrainMotion&);          // fix gravity
  MeshMotion mesh;
};

// NULL: contact by contact. Stops the run where VIELTO_LANES asks for what there is not.
const PackedLaw* packed_law(LAMMPS_NS::LAMMPS* lmp);
// That of the registers of packed_law.
const NearSearch& near_search(LAMMPS_NS::LAMMPS* lmp);

}  // namespace vielto

#endif
