# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the stirred drum in either engine; a run is an array of rows: turn, torque, y, z, y^2, z^2, y z."""
import json
import math
import pathlib

import numpy

from tools import tables
from tools.errors import RunFailed
from tools.yade import DATA, drum, mapping
from tools.yade.engines import start_program

HERE = pathlib.Path(__file__).resolve().parent
SETTINGS = "springFactor 1 limitForce on slidingDashpot off radiusLever off"


def time_step(case):
    return 1 / (case["speed"] * case["rowsPerTurn"] * case["stepsPerRow"])


def contact(case, wall):
    """The contact of two grains, or of a grain and a facet, in the words of the two-body cases."""
    full = dict(dict.fromkeys(mapping.PROPERTIES["vielto"], 0), **case["material"])
    two = {
        "model": "vielto",
        "springFactor": 1,
        "density": case["density"],
        "materials": [full, full],
        "spheres": [{"radius": case["radius"]}] * (1 if wall else 2),
    }
    return mapping.Contact(dict(two, wall="facet") if wall else two)


def yade_materials(case):
    """Of the grain, so that two grains meet as they should; of the wall, so that a grain and the wall do."""
    grain, wall = contact(case, False), contact(case, True)
    common = {"density": case["density"], "frictionAngle": grain.frictionAngle}
    names = {"kn": "normalSpring", "ks": "ks", "cn": "normalDashpot", "cs": "tangentialDashpot"}
    one = {yade: 2 * getattr(grain, ours) for yade, ours in names.items()}
    # a contact's value is a b/(a + b), so b = a c/(a - c) gives c
    other = {yade: one[yade] * getattr(wall, ours) / (one[yade] - getattr(wall, ours)) for yade, ours in names.items()}
    return [dict(common, **one), dict(common, **other)]


def meshes(case, folder):
    (folder / "rotor.stl").write_text(drum.stl("rotor", drum.rotor(case)))
    (folder / "drum.stl").write_text(drum.stl("drum", drum.drum(case)))


def liggghts_files(case, folder, grains, turning):
    """case.par, properties and grains.data for in.drum."""
    full = dict(dict.fromkeys(mapping.PROPERTIES["vielto"], 0), **case["material"])
    (folder / "properties").write_text(
        "".join(
            f"fix {name} all property/global {name} peratomtype {value!r} {value!r}\n" for name, value in full.items()
        )
    )
    rows = round(case["turns"] * case["rowsPerTurn"])
    steps = rows * case["stepsPerRow"] if turning else round(case["settleTime"] / time_step(case))
    values = {
        "dt": repr(time_step(case)),
        "steps": steps,
        "stepsPerRow": case["stepsPerRow"],
        "turning": int(turning),
        "speed": case["speed"],
        "skin": 0.5 * case["radius"],
        "g": case["gravity"],
        "settings": f'"{SETTINGS}"',
    }
    (folder / "case.par").write_text("".join(f"variable {k} index {v}\n" for k, v in values.items()))
    half = 3 * case["drum"]["radius"]
    # sides and blades reach beyond the drum's ends by 0.6 of its length
    along = (min(-half, -0.7 * case["drum"]["length"]), max(half, 1.7 * case["drum"]["length"]))
    box = "".join(f"{low} {high} {a}lo {a}hi\n" for a, (low, high) in zip("xyz", (along, (-half, half), (-half, half))))
    atoms = "".join(
        f"{i + 1} 1 {2 * case['radius']!r} {case['density']} {p[0]!r} {p[1]!r} {p[2]!r}\n"
        for i, p in enumerate(grains.tolist())
    )
    (folder / "grains.data").write_text(f"drum\n\n{len(grains)} atoms\n2 atom types\n\n{box}\nAtoms\n\n{atoms}")


def liggghts(program, case, folder, grains, turning):
    liggghts_files(case, folder, grains, turning)
    start_program([program, "-in", DATA / "stir/in.drum"], folder)
    lines = (folder / "bed.dump").read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]
    end = numpy.array([[float(w) for w in line.split()[1:]] for line in lines])
    check_all_there(case, end, "liggghts")
    if not turning:
        return end
    _, record = tables.read_record(folder / "torque.csv")

    def pick(name):
        return numpy.array([row.number(name) for row in record])

    shape = numpy.loadtxt(folder / "shape.txt")
    shape = shape[shape[:, 0] > 0][:, 1:]
    return numpy.column_stack([pick("turn"), pick("rotor_Nm"), shape])


def yade_run(case, folder, grains):
    """What stir.py needs."""
    return {
        "materials": yade_materials(case),
        "grains": grains.tolist(),
        "radius": case["radius"],
        "rotor": drum.rotor(case),
        "drum": drum.drum(case),
        "speed": case["speed"],
        "dt": time_step(case),
        "rows": round(case["turns"] * case["rowsPerTurn"]),
        "stepsPerRow": case["stepsPerRow"],
        "gravity": case["gravity"],
        "out": str(folder / "rows"),
        "end": str(folder / "end"),
    }


def yade(program, case, folder, grains):
    (folder / "run.json").write_text(json.dumps(yade_run(case, folder, grains)))
    start_program([program, "-n", "-x", "-j1", HERE / "in_yade/stir.py", "run.json"], folder)
    check_all_there(case, numpy.loadtxt(folder / "end"), "yade")
    return numpy.loadtxt(folder / "rows")


def check_all_there(case, places, engine):
    lost = case["grains"] - int(drum.inside(case, places, 0.5 * case["radius"]).sum())
    if lost:
        raise RunFailed(f"{lost} grains left the drum in {engine}; nothing is made of this run")


def observables(case, rows):
    """Means over the turns after `averagedFrom`: what the two engines are compared by."""
    kept = rows[rows[:, 0] > case["averagedFrom"] + 1e-9]
    torque, y, z, yy, zz, yz = kept[:, 1:].mean(axis=0)
    # the bed's slope: the long axis of the grains' scatter in the plane across the axis
    slope = 0.5 * math.degrees(math.atan2(2 * (yz - y * z), (yy - y * y) - (zz - z * z)))
    return {
        "torque_Nm": torque,
        "angle_deg": math.degrees(math.atan2(y, -z)),
        "distance_m": math.hypot(y, z),
        "slope_deg": slope,
    }
