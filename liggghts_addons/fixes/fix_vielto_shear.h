// SPDX-License-Identifier: GPL-2.0-or-later
/* Records a direct shear test: forces on the halves and the load plate, the plate's motion, the bed's porosity.

     fix ID all vielto/shear every N file F part lower M1 part upper M2 part plate M3 mover PLATEFIX velocity V
         displacement D floor Z area A [keywords of fix_vielto_rows.h]
       mover ID         the fix vielto/plate that moves the plate
       velocity V       of the driven half along x, m/s; it starts when this fix is made
       displacement D   of the whole run, m, for the progress line
       floor Z, area A  of the box, m and m2: the bed fills A from Z to the plate

   Force columns: force that the part exerts on the grains, N; lower_Fx_N is positive where the drive supplies.
   displacement_m is the end of the interval, as time_s is; plate_position_m (its lowest point), plate_velocity_m_s,
   dilation_m (rise of the plate since the start) and porosity are means over the interval.
   Global vector: 1 displacement, 2 shear force lower_Fx_N of the last row, 3 greatest overlap so far. */
#ifdef FIX_CLASS
FixStyle(vielto / shear, FixViEltoShear)
#else
#ifndef LMP_FIX_VIELTO_SHEAR_H
#define LMP_FIX_VIELTO_SHEAR_H

#include "fixes/record_base.h"

namespace LAMMPS_NS {

class FixViEltoPlate;

class FixViEltoShear : public FixViEltoRows {
 public:
  FixViEltoShear(class LAMMPS*, int, char**);
  void init() override;
  void setup(int) override;
  double compute_vector(int) override;

 protected:
  void add_step() override;
  std::string header_end() override;
  std::string row() override;
  void clear_interval() override;
  std::string when() const override;
  std::string progress() override;
  std::vector<double> state() override { return {startHeight_}; }
  void set_state(const double* list) override { startHeight_ = list[0]; }

 private:
  double displacement() const { return velocity_ * elapsed(); }

  std::string mover_;
  double velocity_ = 0, whole_ = 0, floor_ = 0, area_ = 0;
  FixViEltoPlate* plate_ = nullptr;
  double startHeight_ = 0;
  double heightSum_ = 0, velocitySum_ = 0;
  double solids_ = 0;  // volume of the grains, m3
  double lastForce_ = 0;
};

}  // namespace LAMMPS_NS
#endif
#endif
