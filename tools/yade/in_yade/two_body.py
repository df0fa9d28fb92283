# SPDX-License-Identifier: GPL-2.0-or-later
"""Two-body cases in Yade:  yade -n -x -j1 two_body.py runs.json

runs.json, written by yade/check, is a list of {law, wall, materials, spheres, gravity, avoidRatcheting, bond, dt,
steps, every, out}.
Each run writes to `out` a line every `every` steps: t, then x v w F T of each sphere; F and T are the whole force and
torque. Yade is a leapfrog: its velocities belong to half steps; the line holds the mean of the two around t.
"""
import json
import sys

LAWS = {
    "ViscEl": (
        ViscElMat,
        {},
        [Ig2_Sphere_Sphere_ScGeom, Ig2_Box_Sphere_ScGeom, Ig2_Facet_Sphere_ScGeom],
        lambda bond: Ip2_ViscElMat_ViscElMat_ViscElPhys(),
        lambda: Law2_ScGeom_ViscElPhys_Basic(),
    ),
    "CohFrict": (
        CohFrictMat,
        {"momentRotationLaw": True},
        [Ig2_Sphere_Sphere_ScGeom6D, Ig2_Box_Sphere_ScGeom6D, Ig2_Facet_Sphere_ScGeom6D],
        lambda bond: Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionOnNewContacts=bond),
        lambda: Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True, useIncrementalForm=True),
    ),
}


def scene(run):
    O.reset()
    material, flags, geometry, physics, law = LAWS[run["law"]]
    for m in run["materials"]:
        O.materials.append(material(**dict(flags, **m)))
    ids = []
    for i, s in enumerate(run["spheres"]):
        ids.append(O.bodies.append(utils.sphere(s["x"], s["radius"], material=i)))
        O.bodies[ids[i]].state.vel = Vector3(s["v"])
        O.bodies[ids[i]].state.angVel = Vector3(s["w"])
    size = 100 * run["spheres"][0]["radius"]
    if run["wall"] == "box":
        O.bodies.append(utils.box((0, 0, -size), (size, size, size), fixed=True, material=1))
    if run["wall"] == "facet":  # one triangle: on the edge of two, forces would count twice
        O.bodies.append(
            utils.facet([(-size, -size, 0), (2 * size, -size, 0), (-size, 2 * size, 0)], fixed=True, material=1)
        )
    sphere_sphere, box_sphere, facet_sphere = geometry
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb(), Bo1_Facet_Aabb()]),
        InteractionLoop(
            [sphere_sphere(avoidGranularRatcheting=run["avoidRatcheting"]), box_sphere(), facet_sphere()],
            [physics(run["bond"])],
            [law()],
        ),
        NewtonIntegrator(damping=0, gravity=Vector3(run["gravity"])),
    ]
    return ids


def simulate(run):
    ids = scene(run)
    states = [O.bodies[b].state for b in ids]
    loads = [Vector3(s["force"]) for s in run["spheres"]]
    gravity, dt = Vector3(run["gravity"]), run["dt"]
    out = open(run["out"], "w")

    for b, f in zip(ids, loads):
        O.forces.setPermF(b, f)

    def forces():
        return [O.forces.f(b) + s.mass * gravity for b, s in zip(ids, states)], [O.forces.t(b) for b in ids]

    def write(t, x, v, w, F, T):
        row = [t] + [q for i in range(len(ids)) for vec in (x[i], v[i], w[i], F[i], T[i]) for q in vec]
        out.write(" ".join("%.17g" % q for q in row) + "\n")

    # The first half kick of the leapfrog, with the forces of the start: a step of no time computes them.
    O.dt = 0
    O.step()
    F, T = forces()
    write(0, [s.pos for s in states], [s.vel for s in states], [s.angVel for s in states], F, T)
    for s, f, t in zip(states, F, T):
        s.vel += 0.5 * dt * f / s.mass
        s.angVel += 0.5 * dt * t / s.inertia[0]
        s.pos += dt * s.vel
    O.dt = dt
    for n in range(1, run["steps"] + 1):
        x, v, w = (
            [Vector3(s.pos) for s in states],
            [Vector3(s.vel) for s in states],
            [Vector3(s.angVel) for s in states],
        )
        O.step()
        if n % run["every"] == 0:
            F, T = forces()
            write(
                n * dt,
                x,
                [0.5 * (a + s.vel) for a, s in zip(v, states)],
                [0.5 * (a + s.angVel) for a, s in zip(w, states)],
                F,
                T,
            )
    out.close()


for one in json.load(open(sys.argv[1])):
    simulate(one)
