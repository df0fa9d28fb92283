# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/library design through its command line: shares, ranges, members of the family, what is refused."""
import csv
import pathlib
import subprocess
import tempfile

LIBRARY = pathlib.Path(__file__).resolve().parents[2] / "scripts/library"
ROWS = 60

with tempfile.TemporaryDirectory(prefix="vielto-design-") as name:
    folder = pathlib.Path(name)
    for effect, low, high in (("warm", -8, 20), ("wet", 0, 100)):
        (folder / f"{effect}.toml").write_text(f"prior_low = {low}\nprior_high = {high}\n")
    # two parameters that go together but for a little: the longest axis is their sum
    members = [(k, 2 * k + (k * 7 % 3) * 0.1) for k in range(30)]
    family = "weight,a,b\n" + "".join(f"1,{a},{b:.1f}\n" for a, b in members)
    (folder / "family.csv").write_text(family)

    def design(*words, out="design.csv"):
        own = ["--effect-files", folder, "--out", folder / out]
        return subprocess.run([LIBRARY, "design", *map(str, [*words, *own])], capture_output=True, text=True)

    told = design("--effects", "warm,wet", "--family", folder / "family.csv", "--runs", ROWS, "--share", 0.4)
    assert told.returncode == 0, told.stderr
    with open(folder / "design.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["warm", "wet", "a", "b"] and len(rows) == ROWS, rows
    for effect, low, high in (("warm", -5.6, 14), ("wet", 0, 70)):
        strengths = [float(row[effect]) for row in rows if row[effect]]
        # a Sobol sequence fills an interval to within (log2 n)/n, five hundredths of 60
        assert abs(len(strengths) / ROWS - 0.4) < 0.1, len(strengths)
        assert low <= min(strengths) < low + 0.15 * (high - low), min(strengths)
        assert high >= max(strengths) > high - 0.15 * (high - low), max(strengths)
        assert abs(sum(strengths) / len(strengths) - (low + high) / 2) < 0.1 * (high - low), strengths
    # both at once in 0.4 x 0.4 of the rows; every member twice, as a whole
    assert abs(sum(bool(row["warm"] and row["wet"]) for row in rows) / ROWS - 0.16) < 0.08
    assert sorted((float(r["a"]), float(r["b"])) for r in rows) == sorted([(a, round(b, 1)) for a, b in members] * 2)
    # parameters and effects do not go together
    present = [float(row["a"]) for row in rows if row["warm"]]
    assert abs(sum(present) / len(present) - 14.5) < 3, present
    # without a family a row without an effect would be the baseline
    told = design("--effects", "warm", "--runs", 20)
    assert told.returncode == 0 and "points without any effect left out" in told.stdout, told
    for words, fault in (
        (("--effects", "cold", "--runs", 8), "cold.toml: No such file or directory"),
        (("--effects", "warm,warm", "--runs", 8), "names one twice"),
        (("--effects", "warm", "--runs", 1), "--runs 1: state 2 to 4096"),
        (("--effects", "warm", "--runs", 8, "--share", 0), "--share 0: state"),
        (("--effects", "warm", "--runs", 8, "--family", folder / "none.csv"), "none.csv: No such file"),
    ):
        bad = design(*words, out="bad.csv")
        assert bad.returncode == 2 and fault in bad.stderr and not (folder / "bad.csv").exists(), bad
