# SPDX-License-Identifier: GPL-2.0-or-later
"""How much a quantity changes with the grain's size, from runs that differ in grain size and seed alone.

  scripts/study size-effect findings/grain_size/shear_grain_size.runs.csv --column plane_friction_coefficient --real 0.0018 --coarse 0.004
  scripts/study size-effect findings/grain_size/repose_grain_size.runs.csv --column angle_deg --real 0.0018 --coarse 0.004
  scripts/study size-effect findings/grain_size/mixer_grain_size.runs.csv --names 'base|d' --column power_W --real 0.0018 --coarse 0.012

A straight line through the column over grainDiameter, every run of the same weight; its u is that of the runs' scatter about
the line (n - 2 degrees of freedom, k = 1). Printed: the mean at each size, the line's value at the real and at the coarse
size, their difference and their ratio with u. A size outside that of the runs is an extrapolation, and called so. --picture draws runs,
line and its standard uncertainty down to the real size.
"""
import math
import pathlib
import re
import statistics

from tools import ROOT, pictures, straight_line, tables
from tools.errors import BadInput

# in every other -var the runs must agree; a fixed ratio of clearance to diameter is a series too, and fewer turns are no other run
OWN = {"run", "seed", "grainDiameter", "clearance", "turns"}
# what stands behind the last _ of a column that has a unit
UNITS = ("W", "Nm", "Pa", "deg", "m", "s", "J")


def add_options(parser):
    parser.add_argument("runs", type=pathlib.Path)
    parser.add_argument("--column", required=True)
    parser.add_argument(
        "--names", default="", metavar="PATTERN", help="only runs whose names begin so, a regular expression"
    )
    parser.add_argument("--real", type=float, required=True, help="grain diameter, m")
    parser.add_argument("--coarse", type=float, required=True, help="grain diameter, m")
    pictures.add_option(parser)


def work(options):
    for name in ("real", "coarse"):
        size = getattr(options, name)
        if not (math.isfinite(size) and size > 0):
            raise BadInput(f"--{name} {size:g}: is no grain diameter; state it in metres, above 0")
    points = read(options.runs, options.column, options.names)
    try:
        a, b, covariance, chi2 = straight_line.fit(points)
    except ValueError as e:
        raise BadInput(f"{options.runs}: {e}; run more sizes or seeds")
    # the line's covariance comes of u = 1; the runs' scatter is its scale
    aa, ab, bb = (chi2 * c for c in covariance)
    if options.picture:
        draw(options.picture, points, (a, b), (aa, ab, bb), options.real, options.column)
    sizes = sorted({x for x, _, _ in points}, reverse=True)
    for size in sizes:
        values = [y for x, y, _ in points if x == size]
        u = f" ± {statistics.stdev(values) / math.sqrt(len(values)):.3g}" if len(values) > 1 else ""
        print(f"{1000 * size:g} mm: {statistics.mean(values):.4g}{u} ({len(values)} runs)")
    real, coarse = a + b * options.real, a + b * options.coarse
    ratio = coarse / real
    # d(coarse/real)/da = (1 - ratio)/real, d/db = (x_c - ratio x_r)/real
    da, db = (1 - ratio) / real, (options.coarse - ratio * options.real) / real
    u_ratio = math.sqrt(da * da * aa + 2 * da * db * ab + db * db * bb)
    for name, size, value in (("real", options.real, real), ("coarse", options.coarse, coarse)):
        outside = "" if sizes[-1] <= size <= sizes[0] else ", extrapolated"
        print(f"line at the {name} size, {1000 * size:g} mm{outside}: {value:.4g}")
    print(f"scatter of a run about the line: {math.sqrt(chi2):.3g}")
    print(f"coarse less real: {coarse - real:.3g} ± {abs(options.coarse - options.real) * math.sqrt(bb):.2g}")
    print(f"coarse over real: {ratio:.4g} ± {u_ratio:.2g}")


def read(path, column, names):
    """[(diameter, value, 1)] of the runs whose names begin so"""
    try:
        wanted = re.compile(names)
    except re.error as e:
        raise BadInput(f"--names {names}: is no regular expression ({e}); name the beginning of the runs' names")
    table = tables.read(path, ["run", "grainDiameter", column], "take runs.csv of a campaign", key="run")
    rows = [row for row in table if wanted.match(row["run"])]
    known = variables() & set(table.header)
    for row in rows:
        for name in sorted(known - OWN):
            if row[name] != rows[0][name]:
                raise row.fault(
                    f"{row['run']} has {name} '{row[name]}', {rows[0]['run']} '{rows[0][name]}'; choose runs that "
                    "differ in grain size alone with --names"
                )
    return [(row.number("grainDiameter", above=0), row.number(column), 1.0) for row in rows]


def variables():
    """Every -var that a rig or a card knows."""
    return {
        name
        for folder in ("cases", "materials")
        for path in ROOT.glob(f"{folder}/**/*.par")
        for name in re.findall(r"^variable (\w+) index", path.read_text(), re.M)
    }


def label(column):
    """`power_W` as an axis has it: power [W]. A column without a unit behind it stays as it is."""
    name, _, unit = column.rpartition("_")
    return f"{name.replace('_', ' ')} [{unit}]" if name and unit in UNITS else column.replace("_", " ")


def draw(path, points, line, covariance, real, column):
    plt = pictures.pyplot()
    a, b = line
    aa, ab, bb = covariance
    largest = max(x for x, _, _ in points)
    at = [real + (largest - real) * k / 50 for k in range(51)]
    middle = [a + b * x for x in at]
    u = [math.sqrt(aa + 2 * ab * x + bb * x * x) for x in at]
    low, high = [m - s for m, s in zip(middle, u)], [m + s for m, s in zip(middle, u)]
    in_mm = [1000 * x for x in at]
    figure, axis = plt.subplots(figsize=(6, 4))
    axis.plot([1000 * x for x, _, _ in points], [y for _, y, _ in points], "o", alpha=0.7, label="a run")
    axis.plot(in_mm, middle, "C1", label="line")
    axis.fill_between(in_mm, low, high, color="C1", alpha=0.25, label="standard uncertainty")
    axis.axvline(1000 * real, color="black", linewidth=0.8, linestyle=":", label="real size")
    axis.set_xlim(0, 1050 * largest)
    axis.set_xlabel("grain diameter [mm]")
    axis.set_ylabel(label(column))
    axis.grid(alpha=0.4)
    axis.legend()
    figure.tight_layout()
    pictures.save(figure, path)
