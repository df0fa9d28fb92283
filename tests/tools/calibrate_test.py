# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/calibrate through its command line, on numbers made from a formula instead of simulations: the posterior is
that of the formula, worked out here on a grid, and what cannot be known stays as wide as the prior."""
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLAN = """members = 50
points = 32
[[parameter]]
name = "phi"
low = 10.0
high = 40.0
[[parameter]]
name = "mu"
low = 0.02
high = 0.5
scale = "log"
[[parameter]]
name = "wall"
low = 20.0
high = 32.0
mean = 26.0
sd = 2.0
[vars]
frictionAngle = "phi"
wall_frictionAngle = "2*wall - phi"
rollingResistance = "mu"
[[run]]
name = "repose"
rig = "repose"
settings = {grainDiameter = "0.004"}
[[target]]
run = "repose"
column = "angle_deg"
u_column = "angle_u_deg"
value = 25.0
u = 1.0
source = "made up"
"""


def angle(phi, mu):  # the wall does not matter
    return 5 + 0.6 * phi + 4 * math.log(mu / 0.02) * (phi / 25) ** 0.3


def calibrate(*words):
    return subprocess.run([ROOT / "scripts/calibrate", *words], capture_output=True, text=True)


try:
    import openturns  # noqa: F401
except ImportError:
    sys.exit(77)
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "plan.toml").write_text(PLAN)
    made = calibrate("design", folder / "plan.toml", "--out", folder / "study.csv")
    assert made.returncode == 0, made.stderr
    rows = list(csv.DictReader((folder / "study.csv").open()))
    assert len(rows) == 32 and rows[0]["grainDiameter"] == "0.004"
    for row in rows:
        row["angle_deg"], row["angle_u_deg"] = angle(float(row["frictionAngle"]), float(row["rollingResistance"])), 0.1
    with open(folder / "runs.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    out = folder / "x.posterior.csv"
    done = calibrate("fit", folder / "plan.toml", folder / "runs.csv", "--out", out)
    assert done.returncode == 0, done.stderr
    result = json.loads((folder / "x.calibration.json").read_text())

    # the same posterior from the formula itself: uniform in phi and log mu, normal in the wall
    n, weights = 200, {}
    for i in range(n):
        for k in range(n):
            phi, lnmu = 10 + 30 * (i + 0.5) / n, math.log(0.02) + math.log(25) * (k + 0.5) / n
            weights[phi, lnmu] = math.exp(-0.5 * (angle(phi, math.exp(lnmu)) - 25) ** 2)
    total = sum(weights.values())
    mean_phi = sum(w * p for (p, _), w in weights.items()) / total
    sd_phi = math.sqrt(sum(w * (p - mean_phi) ** 2 for (p, _), w in weights.items()) / total)
    members = list(csv.DictReader(out.open()))
    assert len(members) == 50 and abs(sum(float(m["weight"]) for m in members) - 1) < 1e-4
    phis = [float(m["frictionAngle"]) for m in members]
    # 50 members of a posterior, spread evenly over it: their mean within a quarter of its sd, the error of 12 random ones
    assert abs(sum(phis) / 50 - mean_phi) < 0.25 * sd_phi, (sum(phis) / 50, mean_phi, sd_phi)
    # each member explains the target: the spread of the angle is that of u and the emulator's error together
    spread = [angle(float(m["frictionAngle"]), float(m["rollingResistance"])) - 25 for m in members]
    error = result["observables"][0]["emulator_error"]
    assert error < 0.5, error
    assert math.sqrt(sum(s * s for s in spread) / 50) < 1.3 * math.hypot(1, error), spread
    # the wall cannot be known from this, the angle's own direction can
    by_name = {p["name"]: p for p in result["parameters"]}
    assert abs(by_name["wall"]["sd_over_prior"] - 1) < 0.05, by_name
    axes = result["axes"]
    assert axes[0]["sd_over_prior"] < 0.4 and axes[-1]["sd_over_prior"] > 0.9, axes
    assert abs(axes[0]["axis"]["wall"]) < 0.1, axes

    # where the plan says that parameters are impossible there is neither a run nor a member of the family
    (folder / "part.toml").write_text(PLAN.replace("points = 32", 'points = 32\nwhere = "phi < 30"'))
    assert calibrate("design", folder / "part.toml", "--out", folder / "part.csv").returncode == 0
    part = list(csv.DictReader((folder / "part.csv").open()))
    assert 10 < len(part) < 32 and all(float(row["frictionAngle"]) < 30 for row in part), part
    assert max(phis) > 31, phis
    done = calibrate("fit", folder / "part.toml", folder / "runs.csv", "--out", folder / "part.posterior.csv")
    assert done.returncode == 0, done.stderr
    assert all(float(m["frictionAngle"]) < 30 for m in csv.DictReader((folder / "part.posterior.csv").open()))

    # a rig's own variables go to its runs alone, into the design and into the check of the numbers
    second = """[[run]]
name = "shear"
rig = "shearbox"
vars = {fillFrictionAngle = "phi / 2"}
"""
    (folder / "two.toml").write_text(PLAN.replace("[[target]]", second + "[[target]]"))
    assert calibrate("design", folder / "two.toml", "--out", folder / "two.csv").returncode == 0
    two = list(csv.DictReader((folder / "two.csv").open()))
    assert [row["run"] for row in two[:2]] == ["repose_1", "shear_1"] and len(two) == 64, two[:2]
    for row in two:
        if row["rig"] == "repose":
            assert row["fillFrictionAngle"] == "", row
        else:  # both printed to six digits
            assert abs(float(row["fillFrictionAngle"]) - float(row["frictionAngle"]) / 2) < 1e-4, row

    bad = calibrate("fit", folder / "plan.toml", folder / "none.csv", "--out", folder / "y.posterior.csv")
    assert bad.returncode == 2 and "none.csv: No such file" in bad.stderr, bad
    (folder / "few.csv").write_text("".join((folder / "runs.csv").read_text().splitlines(True)[:6]))
    bad = calibrate("fit", folder / "plan.toml", folder / "few.csv", "--out", folder / "y.posterior.csv")
    assert bad.returncode == 2 and "only 5 runs of repose" in bad.stderr, bad
    (folder / "other.toml").write_text(PLAN.replace("high = 40.0", "high = 45.0"))
    bad = calibrate("fit", folder / "other.toml", folder / "runs.csv", "--out", folder / "y.posterior.csv")
    assert bad.returncode == 2 and "run the design anew" in bad.stderr, bad
    (folder / "other.toml").write_text(PLAN.replace("value = 25.0", "value = 80.0"))
    bad = calibrate("fit", folder / "other.toml", folder / "runs.csv", "--out", folder / "y.posterior.csv")
    assert bad.returncode == 2 and "the posterior lies on" in bad.stderr, bad
    assert not (folder / "y.posterior.csv").exists()

    # faults of the plan and of the numbers: one line, and no half-written design
    for change, fault in (
        (("points = 32", "points = -1"), "points is -1"),
        (("points = 32", 'points = "many"'), "points is 'many'"),
        (("members = 50", "members = 0"), "members is 0"),
        (("low = ", "lowest = "), "`low` is no number"),
        (("u = ", "u = -"), "no standard uncertainty"),
        (("u_column", "uncertain_column"), "has no text `u_column`"),
        (('= "phi"', '= "phi +"'), "an expression of `vars` or `where` does not work"),
        (('= "phi"', '= "psi"'), "an expression of `vars` or `where` does not work"),
    ):
        assert change[0] in PLAN, change
        (folder / "bad.toml").write_text(PLAN.replace(*change, 1))
        bad = calibrate("design", folder / "bad.toml", "--out", folder / "bad.csv")
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1 and "; " in bad.stderr, (
            change,
            bad,
        )
        assert not (folder / "bad.csv").exists()
    (folder / "bad.toml").write_bytes(bytes(range(256)))
    numbers = (folder / "runs.csv").read_text()
    first = numbers.splitlines(True)[1]
    for words, fault in (
        (("design", folder / "bad.toml", "--out", folder / "bad.csv"), "is no text; name a plan"),
        (("design", folder / "plan.toml", "--out", folder / "none" / "x.csv"), "cannot be written"),
        (("fit", folder / "plan.toml", folder / "bad.toml", "--out", folder / "y.posterior.csv"), "is no CSV table"),
    ):
        bad = calibrate(*words)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
    for text, fault in (
        (numbers + first, "is there twice"),
        (
            numbers.replace(
                first, ",".join(["nan" if c.replace(".", "").isdigit() and "." in c else c for c in first.split(",")])
            ),
            "a finite number",
        ),
    ):
        (folder / "bad.csv").write_text(text)
        bad = calibrate("fit", folder / "plan.toml", folder / "bad.csv", "--out", folder / "y.posterior.csv")
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
    assert not (folder / "y.posterior.csv").exists()
