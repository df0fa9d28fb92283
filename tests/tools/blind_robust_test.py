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
    words = ["vielto", "gap", "diagnose", folder / "b.csv", "--library", "libraries/wheat", "--out", folder / "own"]
    assert run(*words, *HOW).returncode == 0
    own = json.loads((folder / "own/diagnosis.json").read_text())
    first = rows["as stated"]
    assert first["verdict"] == own["verdict"] and first["no_gap"] == f"{own['probabilities']['no_gap']:.3f}", first
    # more prior for causes is less for no gap; eight u are no accident
    assert float(rows["prior of causes x2.5"]["no_gap"]) < float(first["no_gap"]) < 1, rows
    assert float(rows["prior of causes x0.5"]["no_gap"]) > float(first["no_gap"]), rows
    assert float(rows["u x1.5"]["no_gap"]) > float(first["no_gap"]), rows
    assert [p for p in os.listdir(ROOT / "libraries") if p.startswith("half_")] == []

    (folder / "empty.csv").write_text((folder / "b.csv").read_text().replace(",fit,", ",check,"))
    bad = robust(folder / "empty.csv")
    assert bad.returncode == 2 and "holds no row of role fit" in bad.stderr, bad
