# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/study seeds through its command line: means over the seeds of two tables, u by hand, a file that is not there."""
import csv
import math
import pathlib
import subprocess
import tempfile

STUDY = pathlib.Path(__file__).resolve().parents[2] / "scripts/study"
HEAD = "test,role,apparatus,observable,value,u,unit\n"


def run(test, loaded):
    return f"{test},fit,mixer,power_loaded,{loaded},0.1,W\n{test},fit,mixer,power_idle,10,0.1,W\n"


def seeds(*words):
    *tables, out = words
    return subprocess.run([STUDY, "seeds", *tables, "--out", out], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-seeds-") as name:
    name = pathlib.Path(name)
    one, two, out = name / "one.csv", name / "two.csv", name / "out.csv"
    one.write_text(HEAD + run("slow_s1", 30.2) + run("fast_s1", 50))
    two.write_text(HEAD + run("slow_s2", 29.8))
    told = seeds(one, two, out)
    assert told.returncode == 0, told.stderr
    rows = {(r["test"], r["observable"]): r for r in csv.DictReader(out.open())}
    slow, fast = rows[("slow", "power")], rows[("fast", "power")]
    # powers 20.2 and 19.8: 1 % to either side of 20, one degree of freedom, so 1.414 % between seeds
    scatter = math.sqrt(2) * 0.01
    assert float(slow["value"]) == 20 and float(fast["value"]) == 40, rows
    assert slow["u"] == f"{scatter * 20 / math.sqrt(2):.3g}", slow
    assert fast["u"] == f"{scatter * 40:.3g}", fast
    out.unlink()
    bad = seeds(one, name / "none.csv", out)
    assert bad.returncode == 2 and "none.csv: No such file" in bad.stderr and not out.exists(), bad
    # no table is made of what is no table of seeds; nothing half-written stays
    cases = (
        ("", "has no column test"),
        (HEAD, "holds no row"),
        (HEAD + "a_s1,fit,mixer,power,x,0.1,W\n", ":2: value is 'x'"),
        (HEAD + "a_s1,fit,mixer,power,nan,0.1,W\n", ":2: value is 'nan'"),
        (HEAD + "a_s1,fit,mixer,power,1,0,W\n", ":2: u is '0'"),
        (HEAD + "a_s1,fit,mixer\n", ":2: has not as many cells"),
        (HEAD + 2 * "a_s1,fit,mixer,power,1,0.1,W\n", ":3: power of a_s1 is in"),
        (
            HEAD.replace("unit", "unit,speed") + "a_s1,fit,mixer,power,1,0.1,W,1\na_s2,fit,mixer,power,1,0.1,W,1.58\n",
            ":3: speed is '1.58'",
        ),
        ("run,power_W\na,1\n", ":1: has no column test"),
    )
    for text, fault in cases:
        two.write_text(text)
        bad = seeds(two, out)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1 and "; " in bad.stderr, (
            text,
            bad,
        )
        assert not out.exists()
    two.write_bytes(bytes(range(256)))
    for words, fault in (
        ((two, out), "is no CSV table"),
        ((one, one, out), "is in"),
        ((one, name), "cannot be written"),
        ((one, name / "none" / "out.csv"), "cannot be written"),
    ):
        bad = seeds(*words)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
    two.write_text(HEAD.replace("unit", "unit,speed") + "b_s1,fit,mixer,power,1,0.1,W,1\n")
    bad = seeds(one, two, out)
    assert bad.returncode == 2 and "has other columns than" in bad.stderr, bad
    assert sorted(path.name for path in name.iterdir()) == ["one.csv", "two.csv"]
