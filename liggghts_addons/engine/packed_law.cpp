// SPDX-License-Identifier: GPL-2.0-or-later
#include "engine/packed_law.h"

#include <stdlib.h>

#include <string>
#include <vector>

#include "vielto_stop.h"

namespace vielto {

// One for each instruction set that packed_law_target.cpp is compiled for.
#if defined(__x86_64__)
extern const PackedLaw packed_avx512, packed_avx2;
#else
extern const PackedLaw packed_native;
#endif

namespace {

// Widest first.
std::vector<const PackedLaw*> offered() {
  std::vector<const PackedLaw*> laws;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("x86-64-v4")) laws.push_back(&packed_avx512);
  if (__builtin_cpu_supports("x86-64-v3")) laws.push_back(&packed_avx2);
#else
  if (packed_native.search.lanes > 1) laws.push_back(&packed_native);
#endif
  return laws;
}

}  // namespace

const PackedLaw* packed_law(LAMMPS_NS::LAMMPS* lmp) {
  const std::vector<const PackedLaw*> laws = offered();
  const char* const asked = getenv("VIELTO_LANES");
  if (!asked || !*asked) return laws.empty() ? nullptr : laws.front();
  if (asked == std::string("1")) return nullptr;
  std::string there = "1";
  for (const PackedLaw* law : laws) {
    if (asked == std::to_string(law->search.lanes)) return law;
    there += ", " + std::to_string(law->search.lanes);
  }
  stop_all(lmp, (std::string("vielto: VIELTO_LANES=") + asked + ", but this processor can take " + there +
                 " contacts at once; unset it for the most")
                    .c_str());
  return nullptr;
}

const NearSearch& near_search(LAMMPS_NS::LAMMPS* lmp) {
  const PackedLaw* const law = packed_law(lmp);
  return law ? law->search : plain_search;
}

}  // namespace vielto
