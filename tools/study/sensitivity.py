# SPDX-License-Identifier: GPL-2.0-or-later
"""What single changes of a mixer run do to the mixing power, from runs with several seeds.

  scripts/study sensitivity findings/mesh_and_step/sensitivity.runs.csv --out changes.csv --picture changes.png

Runs are named LABEL_sN or LABEL_MORE_sN; those with the label `base` are what the others under the same conditions (speed
and fill) are compared with. Table: label, speed, fill, runs, power_W, its u_W, change (power over that of the base, less 1) and its
u_change (k = 1). u is the scatter between seeds over the root of the number of runs; the relative scatter is pooled over
all labels and conditions, since a few seeds tell little of their own.

--numerical A,B,...: the numerical uncertainty of a base run. Where a label is the run as it should be (a finer step, a finer
mesh), the base is off by its change, known to u_change: its part is sqrt(change^2 + u_change^2), the greatest over
the conditions. The parts and one run's scatter, taken as independent, add up in squares.
"""
import math
import pathlib
import re
from collections import defaultdict
from typing import NamedTuple

from tools import pictures, tables
from tools.errors import BadInput
from tools.study import scatter


class Change(NamedTuple):
    label: str
    speed: str
    fill: str
    runs: int
    power: float
    u_power: float
    change: float
    u_change: float


def add_options(parser):
    parser.add_argument("runs", type=pathlib.Path, nargs="+")
    parser.add_argument("--out", type=pathlib.Path, metavar="TABLE.csv")
    pictures.add_option(parser)
    parser.add_argument("--numerical", metavar="LABELS", help="labels, by commas, that tell what the base is off by")


def work(options):
    rows, spread = changes(read(options.runs))
    parts = numerical(rows, options.numerical.split(","), spread) if options.numerical else None
    if options.out:
        header = ["label", "speed", "fill", "runs", "power_W", "u_W", "change", "u_change"]
        tables.write(options.out, header, [(*row[:4], *(f"{x:.5g}" for x in row[4:])) for row in rows])
    if options.picture:
        draw(options.picture, rows)
    print(f"{'label':16} {'n [1/s]':>8} {'l':>5} {'runs':>4} {'power [W]':>16} {'change [%]':>14}")
    for row in rows:
        power = f"{row.power:.2f} ± {row.u_power:.2f}"
        told = "" if row.label == "base" else f"{100 * row.change:+.1f} ± {100 * row.u_change:.1f}"
        print(f"{row.label:16} {row.speed:>8} {row.fill:>5} {row.runs:4d} {power:>16} {told:>14}")
    print(f"one run scatters by {100 * spread:.1f} % between seeds")
    if parts:
        total = math.sqrt(sum(value**2 for _, value in parts))
        listed = ", ".join(f"{name} {100 * value:.1f}" for name, value in parts)
        print(f"numerical uncertainty of a base run: {100 * total:.1f} % = root of the squares of {listed}")


def read(paths):
    """(label, speed, fill) -> powers of the runs"""
    powers, seen = defaultdict(list), set()
    mend = "take runs.csv of a campaign of mixer runs"
    for path in paths:
        for row in tables.read(path, ["run", "speed", "fill", "power_W"], mend, key="run", seen=seen):
            name = re.fullmatch(r"([^_]+)(_.*)?_s\d+", row["run"])
            if not name:
                raise row.fault(f"run {row['run']} is not named LABEL_sN; name the study's runs so")
            powers[(name[1], row["speed"], row["fill"])].append(row.number("power_W", above=0))
    return powers


def changes(powers):
    """A Change of each label and condition, the bases first; the pooled scatter of a run."""
    spread, freedom = scatter.pooled(powers.values())
    if not freedom:
        raise BadInput("no label has two seeds; the scatter between runs is not known: run a second seed")
    rows = []
    for (label, speed, fill), values in sorted(powers.items(), key=lambda item: (item[0][0] != "base", item[0])):
        base = powers.get(("base", speed, fill))
        if not base:
            raise BadInput(f"{label} at speed {speed}, fill {fill} has no base run under the same conditions; run one")
        power, n = scatter.mean(values), len(values)
        ratio = power / scatter.mean(base)
        u_change = 0.0 if label == "base" else scatter.of_ratio(ratio, spread, n, len(base))
        rows.append(Change(label, speed, fill, n, power, spread * power / math.sqrt(n), ratio - 1, u_change))
    return rows, spread


def numerical(rows, labels, spread):
    """[(part, its relative uncertainty)]"""
    parts = [("one run's scatter", spread)]
    for label in labels:
        of = [math.hypot(row.change, row.u_change) for row in rows if row.label == label]
        if not of:
            raise BadInput(
                f"--numerical {label}: no such label; there are {', '.join(sorted({r.label for r in rows}))}"
            )
        parts.append((label, max(of)))
    return parts


def draw(path, rows):
    plt = pictures.pyplot()
    shown = [row for row in reversed(rows) if row.label != "base"]
    conditions = sorted({(row.speed, row.fill) for row in shown})
    figure, axis = plt.subplots(figsize=(6.4, 1.2 + 0.34 * len(shown)))
    for k, row in enumerate(shown):
        colour = f"C{conditions.index((row.speed, row.fill))}"
        axis.errorbar(100 * row.change, k, xerr=100 * row.u_change, fmt="o", capsize=3, color=colour)
    axis.axvline(0, color="black", linewidth=0.8)
    names = [f"{r.label}  ({r.speed} 1/s, {r.fill})" for r in shown]
    axis.set_yticks(range(len(shown)), names, fontsize=11)
    axis.tick_params(axis="x", labelsize=11)
    axis.set_title("change of the mixing power [%] (speed, fill)", fontsize=12, loc="right")
    axis.grid(axis="x", alpha=0.4)
    figure.tight_layout()
    pictures.save(figure, path)
