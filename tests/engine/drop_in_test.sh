#!/bin/sh
# Drops the contact law into a source tree of LIGGGHTS-PUBLIC 3.8 as doc/start/install.md says, builds it and runs
# an oblique impact of two spheres and one on a turning mesh with it and with our liggghts: the numbers must agree to
# round-off.
#   drop_in_test.sh SOURCE_TREE LIGGGHTS [WORK]
# SOURCE_TREE is copied, never changed. WORK (default: a temporary folder, removed at the end) keeps the build.
set -eu
tree=$1
ours=$2
addons=$(cd "$(dirname "$0")/../../liggghts_addons" && pwd)
if [ $# -gt 2 ]; then
  work=$3
  mkdir -p "$work"
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi

cp -r "$tree/src" "$work/src"
cd "$work/src"
chmod -R u+w .
# what the distribution changed: line 70 does not compile in C++11 mode with GCC 11 or later
sed -i '70s/return static_cast.*/std::ostringstream out; out << std::dec << a; return out.str();/' utils.h
sed -n 70p utils.h | grep -q 'out.str()' || { echo "utils.h line 70 is not what it was in 3.8.0" >&2; exit 1; }

# the drop-in: headers unchanged, one line a law for the fast path
cp "$addons"/*.h "$addons"/law/*.h .
rm normal_model_stock.h  # of the laws that the tree has itself
printf '%s\n' 'GRAN_MODEL(VIELTO, TANGENTIAL_VIELTO, COHESION_OFF, ROLLING_VIELTO, SURFACE_DEFAULT)' \
  'GRAN_MODEL(COHFRICT, TANGENTIAL_OFF, COHESION_OFF, ROLLING_OFF, SURFACE_DEFAULT)' \
  > style_contact_model_user.whitelist
# of the stock combinations one is enough here: the list that LIGGGHTS makes itself has 1200 and takes hours to compile
echo 'GRAN_MODEL(HOOKE, TANGENTIAL_HISTORY, COHESION_OFF, ROLLING_OFF, SURFACE_DEFAULT)' \
  > style_contact_model.whitelist

# a build without VTK, which one source file needs whether asked for or not; -O1 is enough for numbers;
# finish.cpp line 722 orders a pointer and 0, which GCC 11 and later refuse
rm dump_mesh_vtk.cpp dump_mesh_vtk.h
sed -i '722s/numneigh > 0/numneigh/' finish.cpp
sed -e 's/^CC =.*/CC = mpicxx/' -e 's/^LINK =.*/LINK = mpicxx/' \
  -e 's/^CCFLAGS =.*/CCFLAGS = -O1 -std=c++11 -fPIC -w/' \
  -e 's/^LMP_INC =.*/LMP_INC =/' -e 's/^VTK_INC =.*/VTK_INC =/' -e 's/^VTK_LIB =.*/VTK_LIB =/' \
  MAKE/Makefile.mpi > MAKE/Makefile.dropin
make -j "$(nproc)" dropin > make.log 2>&1 || { tail -n 40 make.log >&2; exit 1; }

cd "$work"
cat > plate.stl <<'STL'
solid plate
facet normal 0 0 1
outer loop
vertex -0.04 -0.04 -0.02
vertex 0.04 -0.04 -0.02
vertex 0.04 0.04 -0.02
endloop
endfacet
facet normal 0 0 1
outer loop
vertex -0.04 -0.04 -0.02
vertex 0.04 0.04 -0.02
vertex -0.04 0.04 -0.02
endloop
endfacet
endsolid plate
STL
cat > in.models <<'SCRIPT'
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box
create_box 2 box
neighbor 0.002 bin
neigh_modify delay 0
fix youngsModulus all property/global youngsModulus peratomtype 1e6 2e6
fix stiffnessRatio all property/global stiffnessRatio peratomtype 0.5 0.7
fix frictionAngle all property/global frictionAngle peratomtype 25 15
fix normalDamping all property/global normalDamping peratomtype 0.3 0.1
fix tangentialDamping all property/global tangentialDamping peratomtype 0.3 0.2
fix rollingStiffnessFactor all property/global rollingStiffnessFactor peratomtype 0.5 0.4
fix twistingStiffnessFactor all property/global twistingStiffnessFactor peratomtype 0.5 0.4
fix rollingResistance all property/global rollingResistance peratomtype 0.1 0.2
fix twistingResistance all property/global twistingResistance peratomtype 0.1 0.2
fix alphaKr all property/global alphaKr peratomtype 0.5 0.4
fix alphaKtw all property/global alphaKtw peratomtype 0.5 0.4
fix etaRoll all property/global etaRoll peratomtype 0.1 0.2
fix etaTwist all property/global etaTwist peratomtype 0.1 0.2
fix normalCohesion all property/global normalCohesion peratomtype 1e3 2e3
fix shearCohesion all property/global shearCohesion peratomtype 1e3 2e3
pair_style gran MODELS
pair_coeff * *
create_atoms 1 single 0 0 0 units box
create_atoms 2 single 0.009 0.0048 0 units box
create_atoms 1 single 0.02 0.02 -0.0149 units box
set group all density 1375 diameter 0.01
group second id 2
group third id 3
velocity second set -0.5 0.1 0.05 units box
velocity third set 0.3 0 -0.4 units box
set group all omegax 20 omegay -30 omegaz 60
fix plate all mesh/surface file plate.stl type 2
fix wall all wall/gran MODELS mesh n_meshes 1 meshes plate
fix turn all move/mesh mesh plate rotate origin 0 0 0 axis 0 1 1 period 0.5
timestep 1e-6
fix move all nve/sphere
dump end all custom 600 end.dump id x y z vx vy vz omegax omegay omegaz
dump_modify end sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run 600
SCRIPT

for models in 'model vielto tangential vielto rolling_friction vielto' 'model cohfrict'; do
  echo "$models"
  sed "s/MODELS/$models/" in.models > in.impact
  "$ours" -in in.impact > ours.log 2>&1 || { tail -n 5 ours.log >&2; exit 1; }
  mv end.dump ours.dump
  src/lmp_dropin -in in.impact > dropin.log 2>&1 || { tail -n 5 dropin.log >&2; exit 1; }
  # the last frames number by number: 600 steps of round-off, of velocities up to 1 m/s and spins up to 100 rad/s
  tail -n 3 ours.dump > ours.end
  tail -n 3 end.dump > dropin.end
  paste ours.end dropin.end | awk '
    { for (i = 2; i <= NF / 2; i++) { d = $i - $(i + NF / 2); if (d < 0) d = -d; if (d > worst) worst = d } }
    END { printf "largest difference %g\n", worst; exit !(NR == 3 && worst < 1e-10) }'
done
