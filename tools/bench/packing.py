# SPDX-License-Identifier: GPL-2.0-or-later
"""A packing without walls: grains on a body-centred lattice, 0.5 % closer than they touch, in motion; 8 contacts each."""
import math
import pathlib
import random

D, DENSITY, E, RATIO, ANGLE, DAMPING = 0.008, 1375, 1e6, 0.5, 25, 0.3


def write(folder, cells, copies=1):
    """packing.data and packing.par for liggghts and LAMMPS; the number of grains, 2 cells^3 times the copies along x."""
    edge = 0.995 * D * 2 / math.sqrt(3)
    roll = random.Random(1)
    places = [
        (i + h, j + h, k + h)
        for i in range(copies * cells)
        for j in range(cells)
        for k in range(cells)
        for h in (0, 0.5)
    ]
    mass = DENSITY * math.pi / 6 * D**3
    kn = E * D
    v = 0.02  # m/s: enough that contacts slide and come back, too little to melt the lattice
    with open(pathlib.Path(folder, "packing.data"), "w") as out:
        box = "".join(f"0 {n * cells * edge!r} {a}lo {a}hi\n" for a, n in zip("xyz", (copies, 1, 1)))
        out.write(f"packing\n\n{len(places)} atoms\n1 atom types\n\n{box}\nAtoms\n\n")
        for n, p in enumerate(places):
            out.write(f"{n + 1} 1 {D} {DENSITY} " + " ".join(f"{(q + 0.25) * edge:.9g}" for q in p) + "\n")
        out.write("\nVelocities\n\n")
        for n in range(len(places)):
            out.write(f"{n + 1} " + " ".join(f"{roll.gauss(0, v):.6g}" for _ in range(3)) + " 0 0 0\n")
    values = {
        "E": E,
        "ratio": RATIO,
        "angle": ANGLE,
        "damping": DAMPING,
        "kn": kn,
        "ks": RATIO * kn,
        "kr": 0.5 * RATIO * kn,
        "ktw": 0.5 * RATIO * kn,
        "cn": 2 * DAMPING * math.sqrt(kn * mass / 2),
        "mu": math.tan(math.radians(ANGLE)),
        "skin": 0.25 * D,
        "dt": 0.045 * math.pi * math.sqrt(2 / 7 * mass / kn),
    }
    pathlib.Path(folder, "packing.par").write_text("".join(f"variable {k} index {x:.9g}\n" for k, x in values.items()))
    return len(places)
