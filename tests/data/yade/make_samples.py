# SPDX-License-Identifier: GPL-2.0-or-later
"""Made grains-spheres.0.vtu and grains.txt beside it:  yade -n -x -j1 make_samples.py  (Yade 2023.02a)

A block of 10 x 10 x 10 spheres of 4 to 5 mm radius, 10 mm apart, saved by VTKRecorder and by export.text.
"""
import random

from yade import export

random.seed(1)
for i in range(10):
    for j in range(10):
        for k in range(10):
            O.bodies.append(utils.sphere((0.01 * i, 0.01 * j, 0.01 * k), random.uniform(0.004, 0.005)))
O.dt = 1e-6
O.engines = [VTKRecorder(fileName="grains-", recorders=["spheres"], iterPeriod=1, nDo=1)]
O.step()
export.text("grains.txt")
