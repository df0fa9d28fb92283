# SPDX-License-Identifier: GPL-2.0-or-later
"""workflow/seeds through its command line: means over the seeds of two tables, u by hand, a file that is not there."""
import csv
import math
import pathlib
import subprocess
import tempfile

SEEDS = pathlib.Path(__file__).resolve().parent.parent / "workflow/seeds"
HEAD = "test,role,apparatus,observable,value,u,unit\n"


def run(test, loaded):
    return f"{test},fit,mixer,power_loaded,{loaded},0.1,W\n{test},fit,mixer,power_idle,10,0.1,W\n"


with tempfile.TemporaryDirectory(prefix="vielto-seeds-") as name:
    name = pathlib.Path(name)
    one, two, out = name / "one.csv", name / "two.csv", name / "out.csv"
    one.write_text(HEAD + run("slow_s1", 30.2) + run("fast_s1", 50))
    two.write_text(HEAD + run("slow_s2", 29.8))
    told = subprocess.run([SEEDS, one, two, out], capture_output=True, text=True)
    assert told.returncode == 0, told.stderr
    rows = {(r["test"], r["observable"]): r for r in csv.DictReader(out.open())}
    slow, fast = rows[("slow", "power")], rows[("fast", "power")]
    # powers 20.2 and 19.8: 1 % to either side of 20, one degree of freedom, so 1.414 % between seeds
    scatter = math.sqrt(2) * 0.01
    assert float(slow["value"]) == 20 and float(fast["value"]) == 40, rows
    assert slow["u"] == f"{scatter * 20 / math.sqrt(2):.3g}", slow
    assert fast["u"] == f"{scatter * 40:.3g}", fast
    out.unlink()
    bad = subprocess.run([SEEDS, one, name / "none.csv", out], capture_output=True, text=True)
    assert bad.returncode == 2 and "none.csv: No such file" in bad.stderr and not out.exists(), bad
