# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/study sensitivity through its command line: changes and uncertainties worked out by hand, bad tables."""
import csv
import math
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEAD = "run,rig,speed,fill,power_W\n"


def run(name, power, speed="1", fill="0.15"):
    return f"{name},mixer,{speed},{fill},{power}\n"


def sensitivity(*words):
    return subprocess.run([ROOT / "scripts/study", "sensitivity", *map(str, words)], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-sensitivity-") as name:
    name = pathlib.Path(name)
    table, out = name / "runs.csv", name / "out.csv"
    # base 30 +- 3 % in two seeds, fine 33 +- 3 % in two; whole drum at another speed, one run of each
    good = (
        HEAD
        + run("base_s1", 30.9)
        + run("base_s2", 29.1)
        + run("fine_s1", 33.99)
        + run("fine_s2", 32.01)
        + run("base_fast_s1", 50, "1.58")
        + run("drum_fast_s1", 60, "1.58")
    )
    table.write_text(good)
    told = sensitivity(table, "--out", out, "--numerical", "fine,drum")
    assert told.returncode == 0, told.stderr
    rows = {(r["label"], r["speed"]): r for r in csv.DictReader(out.open())}
    scatter = math.sqrt((2 * 0.03**2 + 2 * 0.03**2) / 2)  # two degrees of freedom
    fine, drum = rows[("fine", "1")], rows[("drum", "1.58")]
    assert abs(float(fine["power_W"]) - 33) < 1e-3 and abs(float(fine["change"]) - 0.1) < 1e-5, fine
    assert abs(float(fine["u_W"]) - 33 * scatter / math.sqrt(2)) < 1e-3, fine
    assert abs(float(fine["u_change"]) - 1.1 * scatter) < 1e-5, fine
    assert (
        abs(float(drum["change"]) - 0.2) < 1e-5 and abs(float(drum["u_change"]) - 1.2 * scatter * math.sqrt(2)) < 1e-5
    ), drum
    parts = scatter, math.hypot(0.1, 1.1 * scatter), math.hypot(0.2, 1.2 * scatter * math.sqrt(2))
    assert f"numerical uncertainty of a base run: {100 * math.hypot(*parts):.1f} %" in told.stdout, told.stdout
    assert "one run scatters by 4.2 % between seeds" in told.stdout, told.stdout

    for text, words, fault in (
        (good.replace("drum_fast_s1", "drum-fast"), (), "run drum-fast is not named LABEL_sN"),
        (HEAD + run("fine_s1", 33) + run("fine_s2", 32), (), "no base run under the same conditions"),
        (HEAD + run("base_s1", 30), (), "no label has two seeds"),
        ("a,b\n1,2\n", (), ":1: has no column run, speed, fill, power_W"),
        (good + good.splitlines()[1] + "\n", (), "is there twice"),
        (HEAD + run("base_s1", 30) + run("base_s2", 0), (), ":3: power_W is '0'"),
        (HEAD + run("base_s1", 30) + run("base_s2", "nan"), (), ":3: power_W is 'nan'"),
        (good, ("--picture", name / "x.foo"), "a picture is .svg or .png"),
        (good, ("--numerical", "step"), "--numerical step: no such label"),
    ):
        table.write_text(text)
        out.unlink(missing_ok=True)
        bad = sensitivity(table, "--out", out, *words)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
        assert not out.exists()
    # the same table twice would count each run twice
    table.write_text(good)
    bad = sensitivity(table, table)
    assert bad.returncode == 2 and "is there twice" in bad.stderr, bad
    bad = sensitivity(name / "none.csv")
    assert bad.returncode == 2 and "No such file" in bad.stderr, bad
