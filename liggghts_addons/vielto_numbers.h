// SPDX-License-Identifier: GPL-2.0-or-later
/* Settings that are no numbers. LIGGGHTS reads a setting's number with atof, so that `springFactor 1,5` is 1 and
   `maxOverlap 5%` is 5 without a word; infinity is no number either. The words of the command that is being executed
   (pair_style, fix wall/gran) are there to look at again. */
#ifndef VIELTO_NUMBERS_H
#define VIELTO_NUMBERS_H

#include <stdlib.h>
#include <string.h>

#include <string>

#include "input.h"
#include "pointers.h"
#include "vielto_stop.h"

namespace vielto {

// Stops the run if `setting` stands in the command and what follows it is no number. Called by postSettings.
inline void refuse_no_number(LAMMPS_NS::LAMMPS* lmp, const char* setting) {
  const LAMMPS_NS::Input* const input = lmp->input;
  for (int k = 0; k + 1 < input->narg; k++) {
    if (strcmp(input->arg[k], setting)) continue;
    const char* const word = input->arg[k + 1];
    char* end = NULL;
    const double value = strtod(word, &end);
    if (end != word && !*end && value - value == 0) continue;
    stop_all(lmp,
             (std::string("vielto: ") + setting + " takes a number with a decimal point, not '" + word + "'").c_str());
  }
}

}  // namespace vielto

#endif
