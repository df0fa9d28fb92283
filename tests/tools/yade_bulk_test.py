# SPDX-License-Identifier: GPL-2.0-or-later
"""yade/bulk through its command line, tiny: the mapping of the wall, taking up what is there, verdicts, bad input.

  yade_bulk_test.py LIGGGHTS      skipped (77) where Yade is not installed
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
if not shutil.which("yade"):
    print("Yade is not installed (scripts/install-packages yade)")
    sys.exit(77)
sys.path.insert(0, str(ROOT))
import numpy  # noqa: E402

from tools.yade import drum, runs  # noqa: E402

case = json.loads((ROOT / "yade/stir/case.json").read_text())

# Yade's contact value a b/(a + b) of grain and wall is that of a sphere and a wall of twice its radius, by hand:
# springs 2 E R and 4 E R give 8/3 E R; the dashpot is 2 beta sqrt(k m).
grain, wall = runs.yade_materials(case)
m, R = case["material"], case["radius"]
k = 8 / 3 * m["youngsModulus"] * R
mass = case["density"] * 4 / 3 * numpy.pi * R**3
for name, value in (
    ("kn", k),
    ("ks", m["stiffnessRatio"] * k),
    ("cn", 2 * m["normalDamping"] * (k * mass) ** 0.5),
    ("cs", 2 * m["tangentialDamping"] * (m["stiffnessRatio"] * k * mass) ** 0.5),
):
    assert abs(grain[name] * wall[name] / (grain[name] + wall[name]) / value - 1) < 1e-12, name

# Every side of the drum is covered by its triangle, seen from inside: the ray to any point of it meets the triangle.
for t in drum.drum(case) + drum.rotor(case):
    assert numpy.linalg.norm(numpy.cross(numpy.subtract(t[1], t[0]), numpy.subtract(t[2], t[0]))) > 0
places = drum.random_grains(case, 1)
assert len(places) == case["grains"] and drum.inside(case, places, R).all() and drum.off_blades(case, places, R).all()
assert not (places == drum.random_grains(case, 2)).all()

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)

    def bulk(*words, tiny=True):
        small = [
            "--set",
            "grains=30",
            "--set",
            "turns=0.15",
            "--set",
            "averagedFrom=0",
            "--set",
            "settleTime=0.05",
            "--seeds",
            "2",
        ]
        done = subprocess.run(
            [ROOT / "yade/bulk", "--liggghts", sys.argv[1], "--out", folder, *(small if tiny else []), *words],
            capture_output=True,
            text=True,
        )
        return done.returncode, done.stdout, done.stderr

    status, out, err = bulk("--limit", "1000")
    assert status == 0, err
    assert out.count("seed ") == 4, out
    assert len((folder / "bulk.csv").read_text().splitlines()) == 5
    assert (folder / "bulk.png").exists()
    differences = list(csv.DictReader((folder / "bulk_differences.csv").open()))
    assert [row["quantity"] for row in differences][0] == "mean torque" and len(differences) == 4, differences
    assert all(float(row["low95"]) <= float(row["difference"]) <= float(row["high95"]) for row in differences)
    assert bulk("--limit", "1000")[1].count("seed ") == 0  # nothing made twice
    (folder / "bulk/2.yade.csv").unlink()
    assert bulk("--limit", "1000")[1].count("seed ") == 1
    status, out, err = bulk("--limit", "1e-9")
    assert status == 1 and "not shown to lie within" in err, err
    assert bulk("--limit", "1000", "--set", "speed=1.1")[1].count("seed ") == 4  # another case

    for words, what in (
        (["--case", "/no/case"], "No such file"),
        (["--set", "cheese=1"], "no number 'cheese'"),
        (["--set", "grains=x"], "'x' is no number"),
        (["--set", "grains=0"], "above 0"),
        (["--set", "stepsPerRow=10"], "multiple of 8"),
        (["--seeds", "1"], "at least 2"),
        (["--set", "grains=99999"], "find no place"),
        (["--set", "averagedFrom=9"], "nothing would be averaged"),
        (["--liggghts", "/no/liggghts"], "no program"),
    ):
        status, out, err = bulk(*words, tiny="find no place" == what)
        assert status == 2 and what in err and err.count("\n") == 1, (words, status, err)
print("bulk: ok")
