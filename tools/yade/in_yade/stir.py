# SPDX-License-Identifier: GPL-2.0-or-later
"""The stirred drum in Yade:  yade -n -x -j1 stir.py run.json

run.json, written by yade/bulk: {materials, grains, radius, rotor, drum, speed, dt, rows, stepsPerRow, gravity, out, end}.
Writes to `out` a row of means every `stepsPerRow` steps: turn, torque on the rotor's axis that the drive supplies, and
the grains' y, z, y^2, z^2, y z; and to `end` the places of the grains.
"""
import json
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(sys.argv[0]).resolve().parent))
from scene import build  # noqa: E402

run = json.load(open(sys.argv[1]))
out = open(run["out"], "w")
torques, shapes = [], []


def torque():
    """About the axis: of the forces and couples on the facets; what the drive supplies has the other sign."""
    sum = Vector3.Zero
    for b in rotor:
        sum += O.forces.t(b) + O.bodies[b].state.pos.cross(O.forces.f(b))
    torques.append(-sum[0])


def shape():
    y, z = numpy.array([O.bodies[b].state.pos for b in grains]).T[1:]
    shapes.append([y.mean(), z.mean(), (y * y).mean(), (z * z).mean(), (y * z).mean()])


def row():
    turn = (O.iter + 1) * O.dt * run["speed"]
    out.write(" ".join("%.9g" % q for q in [turn, numpy.mean(torques), *numpy.mean(shapes, axis=0)]) + "\n")
    torques.clear()
    shapes.clear()


every = run["stepsPerRow"]
grains, rotor = build(
    run,
    look=[
        PyRunner(command="torque()", iterPeriod=8, firstIterRun=7),
        PyRunner(command="shape()", iterPeriod=every // 4, firstIterRun=every // 4 - 1),
        PyRunner(command="row()", iterPeriod=every, firstIterRun=every - 1),
    ],
)
O.run(run["rows"] * every, wait=True)
numpy.savetxt(run["end"], [O.bodies[b].state.pos for b in grains])
out.close()
