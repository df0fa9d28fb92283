# SPDX-License-Identifier: GPL-2.0-or-later
"""A design that varies effects and calibrated parameters together: a table for [[rig.design]] of a library's plan.

Effects multiply, so that a run with several tells of each. A Sobol sequence says in which rows an effect is there and
how strong: in `--share` of them, over the middle `--range` of its prior range; elsewhere the cell is empty. The calibrated parameters of a
row are a member of the family, so that they go together as the calibration leaves them: members evenly along the
family's longest axis, in the order of the sequence.
"""
import pathlib
import tomllib

from tools import tables
from tools.calibration.plans import sobol, writable
from tools.errors import BadInput


def add_options(parser):
    parser.add_argument("--effects", required=True, metavar="NAME,NAME", help="effects that are varied")
    parser.add_argument("--effect-files", type=pathlib.Path, default=pathlib.Path("libraries/effects"))
    parser.add_argument("--family", type=pathlib.Path, metavar="POSTERIOR.csv", help="without it no parameters")
    parser.add_argument("--runs", type=int, required=True, metavar="N", help="rows, each a run at every condition")
    parser.add_argument("--share", type=float, default=1 / 3, help="of the rows that an effect is in (1/3)")
    parser.add_argument("--range", type=float, default=0.7, help="of the prior range on either side of 0 (0.7)")
    parser.add_argument("--out", type=writable, required=True, metavar="TABLE.csv")


def work(options):
    for name, low, high in (("runs", 2, 4096), ("share", 0.01, 1), ("range", 0.01, 1)):
        if not low <= getattr(options, name) <= high:
            raise BadInput(f"--{name} {getattr(options, name):g}: state {low:g} to {high:g}")
    names = options.effects.split(",")
    if len(set(names)) < len(names):
        raise BadInput(f"--effects {options.effects}: names one twice; state each once")
    ranges = [prior_range(options.effect_files / f"{name}.toml") for name in names]
    parameters, members = family(options.family) if options.family else ([], [])
    points = sobol(len(names) + 1, options.runs)
    order = sorted(range(options.runs), key=lambda k: points[k][-1])  # row of each place along the family
    rows = [{} for _ in points]
    for row, point in zip(rows, points):
        for name, (low, high), x in zip(names, ranges, point):
            row[name] = cell(x, options.share, options.range * low, options.range * high)
    for place, k in enumerate(order if members else ()):
        rows[k].update(zip(parameters, members[int((place + 0.5) * len(members) / len(order))]))
    empty = [k + 1 for k, row in enumerate(rows) if not any(row.values())]
    tables.write(options.out, [*names, *parameters], [row for row in rows if any(row.values())])
    left = f"; {len(empty)} points without any effect left out" if empty else ""
    print(f"{len(rows) - len(empty)} rows of {len(names)} effects and {len(parameters)} parameters{left}")


def cell(x, share, low, high):
    """Strength of the coordinate x of the unit interval: none below 1 - share."""
    place = (x - (1 - share)) / share
    strength = low + place * (high - low)
    return f"{strength:.4g}" if place >= 0 and strength else ""


def prior_range(path):
    try:
        effect = tomllib.loads(path.read_text(encoding="utf-8"))
        return float(effect["prior_low"]), float(effect["prior_high"])
    except OSError as e:
        raise BadInput(f"{path}: {e.strerror}; name effects by their files in --effect-files")
    except (KeyError, ValueError, UnicodeDecodeError) as e:
        raise BadInput(f"{path}: states no prior range ({e}); write prior_low and prior_high")


def family(path):
    """Names of the parameters; its members as text, along the longest axis of the family in units of each parameter's
    spread."""
    import numpy as np

    table = tables.read(path, ["weight"], "take posterior.csv of a calibration")
    names = [c for c in table.header if c != "weight"]
    if not names:
        raise BadInput(f"{path}:1: has no parameter beside weight; take posterior.csv of a calibration")
    values = np.array([[row.number(name) for name in names] for row in table])
    spread = values.std(axis=0)
    z = (values - values.mean(axis=0)) / np.where(spread > 0, spread, 1)
    along = z @ np.linalg.svd(z, full_matrices=False)[2][0]
    return names, [[table[k][name] for name in names] for k in np.argsort(along, kind="stable")]
