# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/blind robust on the wheat's table: every change answered with finite numbers, the first as vielto gives it.

  blind_robust_test.py BIN        folder of vielto
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "PATH": f"{pathlib.Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"}
HOW = ["--only", "wall=B", "--ignore", "wall", "--draws", "50"]
TABLE = ROOT / "findings/wheat_walls/observations.csv"


def run(*words):
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, cwd=ROOT, env=ENVIRONMENT)


with tempfile.TemporaryDirectory(prefix="vielto-robust-") as name:
    folder = pathlib.Path(name)

    def robust(table, library=ROOT / "libraries/wheat"):
        words = [ROOT / "scripts/blind", "robust", "--library", library, "--out", folder / "robust.csv", table]
        return run(*words, *HOW)

    # rows of wall B alone, so that each missing row is one of the question
    assert run(ROOT / "scripts/table", "select", TABLE, "--where", "wall=B", "--out", folder / "b.csv").returncode == 0
    done = robust(folder / "b.csv")
    assert done.returncode == 0, done.stderr
    with open(folder / "robust.csv", encoding="utf-8") as file:
        rows = {row["change"]: row for row in csv.DictReader(file)}
    fit = 3
    assert len(rows) == 9 + fit and all(row["verdict"] != "refused" for row in rows.values()), rows

    def diagnosed(table):
        out = folder / f"{table.stem}_answer"
        words = ["vielto", "gap", "diagnose", table, "--library", "libraries/wheat", "--out", out]
        assert run(*words, *HOW).returncode == 0
        return json.loads((out / "diagnosis.json").read_text())

    own, first = diagnosed(folder / "b.csv"), rows["as stated"]
    assert first["verdict"] == own["verdict"] and first["no_gap"] == f"{own['probabilities']['no_gap']:.3f}", first
    # Bayes: prior odds of causes times f leave no gap and unknown in their ratio, p/(p + q + f (1 - p - q)); three digits
    p, q = (own["probabilities"][key] for key in ("no_gap", "unknown"))
    for change, factor in (("prior of causes x0.5", 0.5), ("prior of causes x2.5", 2.5)):
        total = p + q + factor * (1 - p - q)
        for key, was in (("no_gap", p), ("unknown", q)):
            assert abs(float(rows[change][key]) - was / total) < 1e-3, (change, key, was / total, rows[change])
    # u wrong by a factor is the table with that u
    for change, factor in (("u x1.5", 1.5), ("u /1.5", 1 / 1.5)):
        with open(folder / "b.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        for row in table:
            row["u"] = f"{float(row['u']) * factor:.12g}"
        scaled = folder / f"scaled_{factor:.2f}.csv"
        with open(scaled, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, table[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(table)
        expected = diagnosed(scaled)["probabilities"]["no_gap"]
        assert abs(float(rows[change]["no_gap"]) - expected) < 1e-3, (change, expected, rows[change])
        assert rows[change]["no_gap"] != first["no_gap"], rows[change]
    assert [p for p in os.listdir(ROOT / "libraries") if p.startswith("half_")] == []

    # A gap asks for the next test, whose candidates lie beside the settings: no change of the prior may lose them. Another
    # value of a row that shares errors is refused by its covariance, which is an answer too.
    def with_values(factor, path):
        with open(folder / "b.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        for row in table:
            row["value"] = f"{float(row['value']) * factor:.12g}"
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, table[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(table)

    with_values(1.3, folder / "gap.csv")
    done = robust(folder / "gap.csv")
    assert done.returncode == 0, done.stderr
    with open(folder / "robust.csv", encoding="utf-8") as file:
        rows = {row["change"]: row for row in csv.DictReader(file)}
    assert rows["as stated"]["verdict"] not in ("no_gap", "refused"), rows
    assert all("next_tests.toml" not in row["said"] for row in rows.values()), rows
    assert all(rows[f"prior of causes x{f}"]["verdict"] != "refused" for f in (0.5, 2.5)), rows

    (folder / "empty.csv").write_text((folder / "b.csv").read_text().replace(",fit,", ",check,"))
    bad = robust(folder / "empty.csv")
    assert bad.returncode == 2 and "holds no row of role fit" in bad.stderr, bad

    # a table that has no answer as it stands has none when it is changed: slopes over 90 degrees
    with_values(1.6, folder / "steep.csv")
    bad = robust(folder / "steep.csv")
    assert bad.returncode == 2 and "steep.csv" in bad.stderr and "90" in bad.stderr, bad
    assert "Traceback" not in bad.stderr and len(bad.stderr.splitlines()) == 1, bad
