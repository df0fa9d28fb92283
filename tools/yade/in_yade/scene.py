# SPDX-License-Identifier: GPL-2.0-or-later
"""The stirred drum as a Yade scene, from what yade/bulk writes into run.json."""
import numpy
from yade import *  # the classes that Yade knows by name
from yade import utils


def build(run, look=()):
    """Bodies and engines; `look`: engines that see forces and places of one instant. The ids of grains and of blades."""
    grain, wall = [O.materials.append(ViscElMat(**m)) for m in run["materials"]]
    grains = [O.bodies.append(utils.sphere(x, run["radius"], material=grain)) for x in run["grains"]]
    rotor = [O.bodies.append(utils.facet(t, dynamic=False, fixed=True, material=wall)) for t in run["rotor"]]
    for t in run["drum"]:
        O.bodies.append(utils.facet(t, fixed=True, material=wall))
    O.dt = run["dt"]
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()], verletDist=0.3 * run["radius"]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False), Ig2_Facet_Sphere_ScGeom()],
            [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
            [Law2_ScGeom_ViscElPhys_Basic()],
        ),
        *look,
        RotationEngine(
            ids=rotor,
            rotationAxis=(1, 0, 0),
            angularVelocity=2 * numpy.pi * run["speed"],
            rotateAroundZero=True,
            zeroPoint=(0, 0, 0),
        ),
        NewtonIntegrator(damping=0, gravity=(0, 0, -run["gravity"])),
    ]
    return grains, rotor
