#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/docs builds the site without a warning: every page, link, table, figure and question. A figure of a table has the
colour of the page, its words and a dot a row; a table without the column is refused.

  docs_test.py BIN        folder of vielto and vielto_laws
"""
import importlib
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
packages = [p for p in (ROOT / "scripts/packages/docs.txt").read_text().splitlines() if not p.startswith("#")]
known = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Abbrev}", *packages], capture_output=True, text=True)
if known.returncode or known.stdout.count("ii") != len(packages):
    print("the site's packages are not installed:", *packages)
    sys.exit(77)

sys.path[:0] = [str(ROOT), str(ROOT / "doc/_ext")]
plot, results, again, scores = (importlib.import_module(name) for name in ("plot", "results", "again", "scores"))
nodes = importlib.import_module("docutils.nodes")

rows = [{"n": str(n), "angle": str(30 + n), "u": "0.5", "base": base} for n in (1, 2, 4) for base in ("plain", "rough")]
x, y = plot.Value("speed [mm/s] = 10 n"), plot.Value("angle [deg] = angle ± u")
series = plot.series_of(rows, x, [y], "base")
assert [(name, points[0]) for name, points in series] == [
    ("base plain", (10, (31, 30.5, 31.5))),
    ("base rough", (10, (31, 30.5, 31.5))),
], series
drawn = plot.draw(series, x.label, y.label, "x", "")
for word in ("currentColor", "speed [mm/s]", "angle [deg]", "base rough", ">40<"):
    assert word in drawn, word
assert plot.INK not in drawn and "#000000" not in drawn, "a colour that a dark page does not show"


def height_of(word, svg):
    return float(re.search(rf' y="([\d.]+)"[^>]*>{re.escape(word)}<', svg)[1])


# the legend stands above the figure's title, so above every whisker, however many names it has
assert height_of("base rough", drawn) < height_of("angle [deg]", drawn) - 10
many = plot.draw([(f"a name of length {k}", series[0][1]) for k in range(5)], "x", "y")
assert len({height_of(f"a name of length {k}", many) for k in range(5)}) == 3, "two names a row"
assert height_of("a name of length 4", many) < height_of("y", many) - 10

# what is drawn stands below as numbers: a row a place, the scatter where a place has several runs
table = plot.numbers(["x", "runs", "a", "b"], [(1, "1"), (2, "2")], [
    ("a", [(1, (3, 3, 3)), (1, (5, 5, 5)), (2, (7, 6, 8))]), ("b", [(2, (1500, 1000, 1600))])
], [".3g", ".3g"])  # fmt: skip
cells = [entry.astext() for entry in table[1].findall(nodes.entry)]
assert cells == "x runs a b 1 2 4\u00a0±\u00a01 – 2 1 7\u00a0±\u00a01 1500\u00a0[1000,\u00a01600]".split(" "), cells
once = plot.numbers(["x", "runs", "a"], [(1, "1")], [("a", [(1, (3, 3, 3))])], [".3g"])
assert [entry.astext() for entry in once[1].findall(nodes.entry)] == ["x", "a", "1", "3"]
assert plot.numbers(["x", "runs", "a"], [(k, "") for k in range(41)], [("a", [])], [".3g"]) == []

# a straight line through y = 1 + 2 x down to 0
drawn = plot.draw([("y", [(k, (1 + 2 * k, 0, 0)) for k in (2, 3, 4)])], "x", "y", line=("real", 0))
assert "a run" in drawn and "line and its u" in drawn and "real" in drawn

# a line a row, of some rows only, and a band
some = plot.Value("rough = angle (n, u) if base=rough")
places, series = plot.lines_of(rows, [some], "<base> <n>")
assert len(places) == 6 and series == [
    ("rough", [(k, (31 + d, d + 1, 0.5)) for k, d in ((1, 0), (3, 1), (5, 3))])
], series
drawn = plot.draw_lines(places, series, "angle", mark=("wanted", 31, 1))
assert "rough 4" in drawn and "wanted" in drawn and plot.INK not in drawn
assert plot.mark_of("wanted = 2 ± 0.5") == ("wanted", 2, 0.5)
answer = plot.Value("measured = a.b..")
assert answer.label == "measured" and answer.of({"a.b.value": "2", "a.b.low95": "1", "a.b.high95": "4"}) == (2, 1, 4)

# a column that all tables share has one label, factor and format
assert results.stated_fully("max overlap_max") == ("Greatest overlap [%]", "max 100 overlap_max .1f")
assert results.stated_fully("power_W ± u power_W") == ("Power [W]", "power_W .1f ± u power_W .1f")
assert results.stated_fully("worm_gear .2f") == ("Worm gear", "worm_gear .2f")
assert results.stated_fully("max power_W ±") == ("Power [W]", "max power_W .1f ±")
named = {"power_W": "1", "power_u_W": "2", "change": "-0.02", "u_change": "0.01", "value_a": "3", "u_a": "4"}
assert [results.own_u(column, named) for column in ("power_W", "change", "value_a")] == ["power_u_W", "u_change", "u_a"]
assert results.shown([named], "100 change +.0f ±") == "−2\u00a0±\u00a01"
value = plot.Value("power [W] = power_W ± if change=-.*")
assert value.of(named) == (1, -1, 3) and value.of({**named, "change": "1"}) is None
assert results.files_named("a/{X1,X2}/b.json") == [("X1", "a/X1/b.json"), ("X2", "a/X2/b.json")]
assert again.time_and_commands("#!/bin/bash\n# an hour\nset -euo pipefail\nrun it\n") == ("an hour", ["run it"])

# answers: no gap and no name always, an effect where it holds 5 % in one of them
told = scores.rows_of_answers([
    {"verdict": "no_gap", "probabilities": {"no_gap": 0.9, "unknown": 0.02, "drift": 0.04, "shape": 0.01}},
    {"verdict": "unknown", "probabilities": {"no_gap": 0.1, "unknown": 0.6, "drift": 0.3}},
])  # fmt: skip
assert told == [
    ["answer", "no gap", "unknown"],
    ["no gap", "90\u00a0%", "10\u00a0%"],
    ["no name", "2\u00a0%", "60\u00a0%"],
    ["drift", "4\u00a0%", "30\u00a0%"],
], told

# a finding with a program `again` ends with it; another page does not
for page, ends in (("findings/end_walls", True), ("findings/index", False), ("guide/report", False)):
    source = ["text"]
    again.end_finding(None, page, source)
    assert source[0].endswith("```{again}\n```\n") == ends, page

for wrong, fault in (
    (lambda: plot.series_of(rows, x, [plot.Value("y = no_such")], None), KeyError),
    (lambda: plot.Value("no_such"), ValueError),
    (lambda: results.shown(rows, results.stated_fully("no_such")[1]), KeyError),
    (lambda: results.own_u("power_W", {"power_W": "1"}), KeyError),
    (lambda: again.time_and_commands("#!/bin/bash\nrun it\n"), ValueError),
):
    try:
        wrong()
    except fault:
        continue
    raise SystemExit("what is wrong was taken")

done = subprocess.run(
    [ROOT / "scripts/docs"], env={**os.environ, "VIELTO_BIN": sys.argv[1]}, capture_output=True, text=True
)
assert done.returncode == 0, done.stdout + done.stderr
print(done.stdout)
