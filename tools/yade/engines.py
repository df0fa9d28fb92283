# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the two-body cases in either engine; each run becomes an array [time, sphere, 15]: x v w F T."""
import json
import os
import pathlib
import subprocess

import numpy

from tools.errors import RunFailed
from tools.yade import DATA, mapping

MODELS = {"vielto": "model vielto tangential vielto rolling_friction vielto", "cohfrict": "model cohfrict"}
HERE = pathlib.Path(__file__).resolve().parent


def start_program(command, folder):
    # a single process needs no transport between processes, and no session folder that others remove
    env = dict(
        os.environ,
        OMPI_ALLOW_RUN_AS_ROOT="1",
        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
        OMP_NUM_THREADS="1",
        OMPI_MCA_ess_singleton_isolated="1",
        OMPI_MCA_pml="ob1",
        OMPI_MCA_btl="self",
        OMPI_MCA_orte_tmpdir_base=str(folder),
    )
    done = subprocess.run(
        [str(c) for c in command],
        cwd=folder,
        env=env,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
    )
    if done.returncode != 0:
        raise RunFailed(
            f"{' '.join(str(c) for c in command)} in {folder} ended with {done.returncode}:\n"
            + (done.stdout + done.stderr)[-1200:]
        )


def steps(case, samples, level):
    """Steps and steps between samples for the time step case['step']/2^level; samples fall on common times."""
    n = round(case["end"] / case["step"])
    every = max(1, n // samples)
    return n // every * every * 2**level, every * 2**level


def liggghts(program, case, folder, samples, level):
    spheres = mapping.start(case)
    count, every = steps(case, samples, level)
    half = 50 * max(s["radius"] for s in spheres)
    gravity = case.get("gravity", [0, 0, 0])
    g = sum(a * a for a in gravity) ** 0.5
    values = {
        "dt": repr(case["step"] / 2**level),
        "steps": count,
        "every": every,
        "skin": 0.5 * spheres[0]["radius"],
        "wall": int("wall" in case),
        "g": repr(g),
        "force": case.get("force", 0),
    }
    values.update(zip(("gx", "gy", "gz"), map(repr, gravity)))
    (folder / "properties").write_text(
        "".join(
            f"fix {name} all property/global {name} peratomtype {' '.join(repr(m[name]) for m in case['materials'])}\n"
            for name in mapping.PROPERTIES[case["model"]]
        )
    )
    settings = [f"{name} {case[name]}" for name in mapping.SETTINGS[case["model"]]]
    if "wall" in case:
        settings.append(f"wallRadiusFactor {mapping.WALL_RADIUS_FACTOR[case['wall']]}")
    values["models"] = f'"{MODELS[case["model"]]}"'
    values["settings"] = '"' + " ".join(settings) + '"'
    (folder / "case.par").write_text("".join(f"variable {k} index {v}\n" for k, v in values.items()))

    def row(*numbers):
        return " ".join(repr(float(n)) for n in numbers)

    box = "".join(f"{-half} {half} {a}lo {a}hi\n" for a in "xyz")
    atoms = "".join(
        f"{i + 1} {i + 1} {row(2 * s['radius'], case['density'], *s['x'])}\n" for i, s in enumerate(spheres)
    )
    moves = "".join(f"{i + 1} {row(*s['v'], *s['w'])}\n" for i, s in enumerate(spheres))
    (folder / "grains.data").write_text(
        f"{case['name']}\n\n{len(spheres)} atoms\n2 atom types\n\n{box}\nAtoms\n\n{atoms}" f"\nVelocities\n\n{moves}"
    )
    start_program([program, "-in", DATA / "contact/in.two_body"], folder)
    rows = [line.split() for line in (folder / "states").read_text().splitlines()]
    data = numpy.array([[float(w) for w in r[1:]] for r in rows if len(r) == 16])
    return data.reshape(-1, len(spheres), 15)


def yade_run(case, folder, samples, level):
    """What two_body.py needs for one run."""
    count, every = steps(case, samples, level)
    return {
        "law": case["law"],
        "wall": case.get("wall", ""),
        "materials": mapping.yade_materials(case),
        "spheres": mapping.start(case),
        "gravity": case.get("gravity", [0, 0, 0]),
        "avoidRatcheting": case["avoidRatcheting"] == "on",
        "bond": case["bondNewContacts"] == "on",
        "dt": case["step"] / 2**level,
        "steps": count,
        "every": every,
        "out": str(folder / f"{case['name']}.{level}"),
    }


def yade(program, runs, folder):
    """All runs in one process, for Yade takes seconds to start."""
    (folder / "runs.json").write_text(json.dumps(runs))
    start_program([program, "-n", "-x", "-j1", HERE / "in_yade/two_body.py", "runs.json"], folder)
    return [numpy.loadtxt(r["out"])[:, 1:].reshape(-1, len(r["spheres"]), 15) for r in runs]
