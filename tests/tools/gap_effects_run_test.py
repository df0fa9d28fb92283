# SPDX-License-Identifier: GPL-2.0-or-later
"""Every effect that acts on the mixer, by its own file, in a small run of it: with all switches at zero the record is the
baseline's bit for bit; with one effect on, the parameters that its file names change, no others, and so does the record;
the mesh changes with the effects on the geometry alone. Figures of how strongly: scripts/library responses, gap/README.md.
   gap_effects_run_test.py BIN    folder of our liggghts and vielto"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(sys.argv[1]).resolve()
ENV = dict(
    os.environ, PATH=f"{BIN}:{os.environ['PATH']}", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"
)
# small: soft, coarse grain, few of them, a third of a turn's filling
SETTINGS = dict(
    grainDiameter="0.016", youngsModulus="2e5", wall_youngsModulus="2e5", maxOverlap="0.3", settleTime="0.25", turns="1"
)
STRENGTHS = dict(
    cohesion=300,
    shape=0.4,
    wall_friction=12,
    size_spread=0.2,
    dissipation=0.33,
    air_drag=4,
    paddle_clearance=0.004,
    coarse_grain=-0.3,
    soft_grain=0.5,
    slice_ends=1,
    faceting=1,
    wall_rolling=0.6,
)
GEOMETRY = {"paddle_clearance", "slice_ends", "faceting"}  # and no other effect touches a mesh


def plan_of(strengths):
    settings = ", ".join(f'{k} = "{v}"' for k, v in SETTINGS.items())
    text = (
        f'seeds = 6\n[[rig]]\nname = "mixer"\nsettings = {{{settings}}}\nconditions = [{{speed = 1.5, fill = 0.05}}]\n'
    )
    for name, strength in strengths.items():
        text += f'[[rig.effect]]\nname = "{name}"\nstrengths = [{strength}]\nat = [1]\n'
    return text


def run(folder, settings):
    words = [word for name, value in settings.items() for word in ("-var", name, value)]
    done = subprocess.run(
        ["liggghts", "-in", "in.mixer", *words, "-var", "run", folder],
        cwd=ROOT / "cases/mixer",
        env=ENV,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, f"{folder.name}: {done.stdout[-2000:]}{done.stderr}"
    return folder


def record(folder):
    """Steps and numbers, without the lines on top that repeat the parameters."""
    return [line for line in (folder / "torque.csv").read_text().splitlines() if not line.startswith("#")]


def meshes(folder):
    return {path.name: path.read_bytes() for path in sorted((folder / "mesh").glob("*.stl"))}


def parameters(folder):
    return {
        k: v for k, v in json.loads((folder / "run.json").read_text())["parameters"].items() if k not in ("run", "seed")
    }


def grains(folder):
    """Radii of the last state (legacy VTK: `radius 1 COUNT double`, then the numbers)."""
    text = next((folder / "vtk").glob("grains_[0-9]*.vtk")).read_text(errors="replace")
    words = text[text.index("\nradius ") :].split()
    return [float(word) for word in words[4 : 4 + int(words[2])]]


def header(folder, name):
    return next(line.split("=")[1] for line in (folder / "torque.csv").open() if line.startswith(f"# {name}="))


with tempfile.TemporaryDirectory(prefix="vielto-effects-") as name:
    folder = pathlib.Path(name)
    acting = {
        path.stem
        for path in (ROOT / "libraries/effects").glob("*.toml")
        # a variable that names no rigs acts on all
        for variable in tomllib.loads(path.read_text()).get("apply", {}).get("var", [])
        if "mixer" in variable.get("rigs", ["mixer"])
    }
    assert acting == set(STRENGTHS), acting ^ set(STRENGTHS)  # an effect that is added is tested too
    (folder / "library").mkdir()
    (folder / "library/plan.toml").write_text(plan_of(STRENGTHS))
    planned = subprocess.run(
        [
            "vielto",
            "gap",
            "plan",
            folder / "library/plan.toml",
            "--effects",
            ROOT / "libraries/effects",
            "--settings",
            ROOT / "libraries/diagnosis.toml",
            "--root",
            ROOT,
            "--out",
            folder / "study.csv",
        ],
        env=ENV,
        capture_output=True,
        text=True,
    )
    assert planned.returncode == 0, planned.stderr
    with open(folder / "study.csv", newline="") as file:
        rows = {
            row.pop("run"): {k: v for k, v in row.items() if v and k not in ("rig", "seed")}
            for row in csv.DictReader(file)
        }
    settings_of = {
        name: next(s for run, s in rows.items() if f"_{name}{strength}_" in run) for name, strength in STRENGTHS.items()
    }
    baseline = run(folder / "baseline", rows["mixer1_none_s1"])
    base = parameters(baseline)

    # every switch there is, at its zero
    changed = {
        k for settings in settings_of.values() for k, v in settings.items() if rows["mixer1_none_s1"].get(k) != v
    }
    zero = {k: base[k] for k in changed} | {"cohesion": "adhesion"}  # a word: adhesion of 0 Pa
    still = run(folder / "zero", rows["mixer1_none_s1"] | zero)
    assert record(still) == record(baseline) and meshes(still) == meshes(baseline)

    made = {}
    for effect, settings in settings_of.items():
        made[effect] = at = run(folder / effect, settings)
        own = {k for k, v in settings.items() if rows["mixer1_none_s1"].get(k) != v}
        assert {k for k, v in parameters(at).items() if v != base[k]} == own, (effect, own)
        assert record(at) != record(baseline), f"{effect} changes nothing"
        assert (meshes(at) != meshes(baseline)) == (effect in GEOMETRY), effect

    # and where it should
    few, many = grains(baseline), grains(made["coarse_grain"])
    assert abs(len(many) / len(few) * 0.7**3 - 1) < 0.05, (len(few), len(many))  # the same mass

    def spread(r):
        return (sum((x - sum(r) / len(r)) ** 2 for x in r) / len(r)) ** 0.5 / (sum(r) / len(r))

    # three sizes of weights 1/6, 2/3, 1/6 by mass; drawn grain by grain, so that ten per cent is left to chance
    assert spread(grains(made["size_spread"])) > 3 * spread(few), (spread(few), spread(grains(made["size_spread"])))
    ratio = float(header(made["soft_grain"], "dt")) / float(header(baseline, "dt"))
    assert abs(ratio * 10**0.25 - 1) < 0.01, ratio  # half a decade stiffer: half period by the root
    assert len(meshes(made["faceting"])["drum.stl"]) < len(meshes(baseline)["drum.stl"])
    assert len(grains(made["slice_ends"])) > 5 * len(few)
print("every effect acts, and none at zero")
