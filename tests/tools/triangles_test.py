# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/study triangles through its command line: a power law known by hand, the triangles that bench/run counted, bad tables.
triangles_test.py BIN"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADER = "run,seed,speed,fill,grainDiameter,drumSegments,shaftSegments,power_W\n"


def triangles(table, *words):
    return subprocess.run(
        [ROOT / "scripts/study", "triangles", table, *words],
        capture_output=True,
        text=True,
        env=dict(os.environ, PATH=f"{sys.argv[1]}:{os.environ['PATH']}"),
    )


with tempfile.TemporaryDirectory(prefix="vielto-triangles-") as name:
    table = pathlib.Path(name) / "runs.csv"
    # bench/run counted the triangles of its meshes by itself: 24, 48, 96 chords
    counted = {
        t["triangles"]: t["median"]
        for t in json.loads((ROOT / "bench/results.json").read_text())["us_per_step_by_triangles"]
    }
    meshes = dict(zip(((24, 12), (48, 24), (96, 48)), sorted(counted)))
    rows = [
        f"m{d}_s{s},{s},0.85,0.15,0.012,{d},{h},{20 * t**0.1 * e!r}\n"
        for (d, h), t in meshes.items()
        for s, e in ((1, 1.02), (2, 1 / 1.02))
    ]
    table.write_text(HEADER + "".join(rows))
    told = triangles(table)
    assert told.returncode == 0, told.stderr
    # ln P = ln 20 + 0.1 ln T +- ln 1.02 at each mesh: the residuals are all ln 1.02, on 6 - 2 degrees of freedom
    x = [math.log(t) for t in meshes.values()]
    spread = 2 * sum((a - sum(x) / 3) ** 2 for a in x)
    u = math.sqrt(6 * math.log(1.02) ** 2 / 4 / spread)
    assert f"slope of ln(power) over ln(triangles): 0.100 ± {u:.3f}" in told.stdout, told.stdout
    lines = told.stdout.splitlines()
    for line, ((d, h), t) in zip(lines[1:4], meshes.items()):
        cells = line.split(",")
        assert cells[:4] == [str(t), str(d), str(h), "2"], line
        middle = (1.02 + 1 / 1.02) / 2
        assert math.isclose(float(cells[4]), 20 * t**0.1 * middle, rel_tol=1e-3), line
        # two seeds at +-(1.02 - 1/1.02)/2 of the mean: relative scatter sqrt(2) times that
        scatter = math.sqrt(2) * (1.02 - 1 / 1.02) / 2 / middle
        assert math.isclose(float(cells[5]), scatter * float(cells[4]) / math.sqrt(2), rel_tol=2e-3), line
        assert math.isclose(float(cells[6]), (t / max(meshes.values())) ** 0.1 - 1, abs_tol=1e-3), line
        assert math.isclose(float(cells[8]), counted[t], rel_tol=1e-3), line
    picture, out = pathlib.Path(name) / "p.svg", pathlib.Path(name) / "t.csv"
    drawn = triangles(table, "--picture", picture, "--out", out)
    if "needs matplotlib" in drawn.stderr:
        assert drawn.returncode == 2 and not picture.exists()
    else:
        assert "<svg" in picture.read_text() and out.read_text().splitlines() == lines[:4], drawn.stderr
    assert not list(pathlib.Path(name).glob("*.partial*"))

    for text, fault in (
        (HEADER + "".join(rows[:4]), "needs three meshes"),
        (HEADER, "holds no row"),
        (HEADER + "".join(rows[:5]) + rows[5].replace("0.85", "1.58"), ":7: m96_s2 has speed '1.58'"),
        (HEADER + "".join(rows[:5]) + rows[5].replace(",96,48,", ",0,48,"), ":7: drumSegments is '0'"),
        (HEADER + "".join(rows).replace(",96,48,", ",361,48,"), "drumSegments"),
        (HEADER.replace("shaftSegments,", "") + rows[0], ":1: has no column shaftSegments"),
    ):
        table.write_text(text)
        bad = triangles(table)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
