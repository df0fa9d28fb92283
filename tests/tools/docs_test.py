#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/docs builds the site without a warning: every page, link, table, figure and question. A figure of a table has the
colour of the page, its words and a dot a row; a table without the column is refused.

  docs_test.py BIN        folder of vielto and vielto_laws
"""
import importlib
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
packages = [p for p in (ROOT / "scripts/packages/docs.txt").read_text().splitlines() if not p.startswith("#")]
known = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Abbrev}", *packages], capture_output=True, text=True)
if known.returncode or known.stdout.count("ii") != len(packages):
    print("the site's packages are not installed:", *packages)
    sys.exit(77)

sys.path[:0] = [str(ROOT), str(ROOT / "doc/_ext")]
plot = importlib.import_module("plot")

rows = [{"n": str(n), "angle": str(30 + n), "base": base} for n in (1, 2, 4) for base in ("plain", "rough")]
x, y = plot.column("speed [mm/s] = 10 n"), plot.column("angle [deg] = angle")
series = plot.series_of(rows, x, [y], "base")
assert [(name, points[0]) for name, points in series] == [("base plain", (10, 31)), ("base rough", (10, 31))], series
drawn = plot.draw(series, x[0], y[0], "x", "")
for word in ("currentColor", "speed [mm/s]", "angle [deg]", "base rough", ">40<"):
    assert word in drawn, word
assert plot.INK not in drawn and "#000000" not in drawn, "a colour that a dark page does not show"
try:
    plot.series_of(rows, x, [plot.column("y = no_such")], None)
    raise SystemExit("a missing column was drawn")
except KeyError:
    pass

done = subprocess.run(
    [ROOT / "scripts/docs"], env={**os.environ, "VIELTO_BIN": sys.argv[1]}, capture_output=True, text=True
)
assert done.returncode == 0, done.stdout + done.stderr
print(done.stdout)
