# SPDX-License-Identifier: GPL-2.0-or-later
"""Mixing power and cost of a step against the number of triangles of drum and shaft.

  scripts/study triangles findings/mesh_and_step/mixer_triangles.runs.csv --picture triangles.png     with `vielto` on the PATH

Runs of one mixer that differ in drumSegments, shaftSegments and seed alone (scripts/campaign mixer_triangles). The triangles are
counted in the mesh that `vielto geometry` makes; the time of a step with as many is that of bench/results.json, where it
was measured with the meshes taking turns. Table: triangles, drumSegments, shaftSegments, runs, power_W, u_W, change (power over that of the
finest mesh, less 1), u_change, step_us. u (k = 1) is the scatter between seeds, pooled over the meshes, over the root of
the number of runs. Last line: the slope of ln(power) over ln(triangles) with its u, from all runs.
"""
import math
import pathlib
import subprocess
import tempfile
from collections import defaultdict

from tools import ROOT, files, pictures, straight_line, tables
from tools.errors import BadInput
from tools.study import scatter

MEND = "take runs.csv of scripts/campaign mixer_triangles"
MESH = ("drumSegments", "shaftSegments")
HEADER = ["triangles", *MESH, "runs", "power_W", "u_W", "change", "u_change", "step_us"]


def add_options(parser):
    parser.add_argument("runs", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, metavar="TABLE.csv", help="without it on the screen")
    pictures.add_option(parser)


def work(options):
    powers = read(options.runs)
    spread, _ = scatter.pooled(powers.values())
    triangles = {mesh: count(mesh) for mesh in powers}
    step = step_times()
    rows = [row_of(mesh, powers, triangles, spread, step) for mesh in sorted(powers, key=triangles.get)]
    points = [(math.log(triangles[mesh]), math.log(x), 1.0) for mesh, p in powers.items() for x in p]
    _, slope, (_, _, variance), chi2 = straight_line.fit(points)
    told = [[f"{v:.4g}" if isinstance(v, float) else v for v in row.values()] for row in rows]
    if options.out:
        tables.write(options.out, HEADER, told)
    else:
        print(tables.text(HEADER, told), end="")
    if options.picture:
        draw(options.picture, rows, step)
    u = math.sqrt(variance * chi2)
    print(f"slope of ln(power) over ln(triangles): {slope:.3f} ± {u:.3f}; scatter of a run {100 * spread:.1f} %")


def read(path):
    """(drumSegments, shaftSegments) -> powers"""
    powers = defaultdict(list)
    same = ("speed", "fill", "grainDiameter")
    rows = tables.read(path, ["run", "seed", *same, *MESH, "power_W"], MEND, key="run")
    for row in rows:
        for name in same:
            if row[name] != rows[0][name]:
                raise row.fault(
                    f"{row['run']} has {name} '{row[name]}', {rows[0]['run']} '{rows[0][name]}'; "
                    "take runs that differ in the mesh alone"
                )
        mesh = tuple(int(row.number(name, above=0)) for name in MESH)
        powers[mesh].append(row.number("power_W", above=0))
    if len(powers) < 3 or all(len(p) < 2 for p in powers.values()):
        raise BadInput(f"{path}: needs three meshes, and one with two seeds; {MEND}")
    return powers


def row_of(mesh, powers, triangles, spread, step):
    values, finest = powers[mesh], powers[max(powers, key=triangles.get)]
    n, power = len(values), scatter.mean(values)
    ratio = power / scatter.mean(finest)
    u_change = 0.0 if values is finest else scatter.of_ratio(ratio, spread, n, len(finest))
    took = step.get(triangles[mesh], ("",))[0]
    u = spread * power / math.sqrt(n)
    return dict(zip(HEADER, (triangles[mesh], *mesh, n, power, u, ratio - 1, u_change, took)))


def count(mesh):
    """Triangles of the slice that the rig makes with these segments."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "mesh")
        settings = [f"--set={name}={n}" for name, n in zip(MESH, mesh)]
        words = ["vielto", "geometry", ROOT / "cases/mixer/mixer.par", "--out", out, *settings]
        try:
            done = subprocess.run(words, capture_output=True, text=True)
        except FileNotFoundError:
            raise BadInput(
                "there is no `vielto` on the PATH; build it (scripts/build release vielto) and put build/bin there"
            )
        if done.returncode:
            raise BadInput(done.stderr.strip() or done.stdout.strip())
        return sum(stl.read_text().count("endfacet") for stl in out.glob("*.stl"))


def step_times():
    """triangles -> (median, low, high) of a step, us"""
    results = files.read_json(ROOT / "bench/results.json", "make it with bench/run --part triangles")
    return {row["triangles"]: (row["median"], row["low"], row["high"]) for row in results["us_per_step_by_triangles"]}


def draw(path, rows, step):
    plt = pictures.pyplot()
    figure, (power, time) = plt.subplots(2, 1, sharex=True, figsize=(6, 5.5))
    at = [r["triangles"] for r in rows]
    power.errorbar(at, [r["power_W"] for r in rows], [r["u_W"] for r in rows], fmt="o", capsize=4)
    power.set_ylim(0, 1.3 * max(r["power_W"] for r in rows))
    power.set_ylabel("mixing power [W]")
    known = sorted(step)
    middle = [step[t][0] for t in known]
    reach = [[step[t][0] - step[t][1] for t in known], [step[t][2] - step[t][0] for t in known]]
    time.errorbar(known, middle, reach, fmt="o", color="C1", capsize=4)
    time.set_ylim(bottom=0)
    time.set_ylabel("time of a step [µs]")
    time.set_xlabel("triangles")
    time.set_xscale("log")
    time.set_xticks(at, [str(t) for t in at])
    time.minorticks_off()
    for axis in (power, time):
        axis.grid(alpha=0.4)
    figure.tight_layout()
    pictures.save(figure, path)
