// The contact law in a program of one's own (doc/guide/own_scripts.md): the normal force of two grains.
#include <cstdio>

#include "vielto_law.h"

int main() {
  vielto::Material grain{2e5, 0.5, 0.44, 0.3, 0, 0.5, 0.5, 0.1, 0.1};
  const double R = 0.005, mass = 1375 * 4.0 / 3.0 * 3.14159265 * R * R * R;
  const auto pair = vielto::mix(grain, grain);
  const auto k = vielto::stiffness(pair, R, R, mass / 2);
  // an overlap of 10 micrometres that grows by 1 cm/s; springFactor is 4
  std::printf("force %.6g N\n", vielto::normal_force(4, k, 1e-5, -0.01));
}
