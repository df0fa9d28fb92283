# SPDX-License-Identifier: GPL-2.0-or-later
"""Means over the seeds of a study's observations.

  scripts/study seeds results/studies/NAME/observations.csv... --out OUT.csv

Tests that differ in the ending _sN of their names only are one test; their conditions must be equal. Of N runs with values
x and uncertainties u the mean is given with the standard uncertainty max(s_rel |mean|, rms(u))/sqrt(N), where s_rel is the
relative standard deviation between seeds, pooled over all tests of that observable (a handful of seeds tells little of its
own spread). Where both power_loaded and power_idle are there, `power` is added, their difference run by run.
"""
import math
import pathlib
import re
from collections import defaultdict

from tools import tables
from tools.errors import BadInput
from tools.study import scatter

COLUMNS = ["test", "role", "apparatus", "observable", "value", "u", "unit"]
MEND = "take observations.csv of a campaign"


def add_options(parser):
    parser.add_argument("observations", type=pathlib.Path, nargs="+")
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="TABLE.csv")


def work(options):
    header, rows = read(options.observations)
    groups = grouped([*rows, *powers(rows)])
    of_observable = defaultdict(list)
    for (_, observable), members in groups.items():
        of_observable[observable].append([m["value"] for m in members])
    spread = {observable: scatter.pooled(values) for observable, values in of_observable.items()}
    tables.write(options.out, header, [mean(test, members, spread[of][0]) for (test, of), members in groups.items()])
    for observable, (s, freedom) in sorted(spread.items()):
        print(f"{observable}: {100 * s:.2f} % between seeds ({freedom} degrees of freedom)")


def read(paths):
    """The header, and the rows with numbers for value and u."""
    rows, seen, header = [], {}, None
    for path in paths:
        table = tables.read(path, COLUMNS, MEND)
        header = header or table.header
        if table.header != header:
            raise BadInput(f"{path}:1: has other columns than {paths[0]}; {MEND}, of one version")
        for row in table:
            of = (row["test"], row["observable"])
            if of in seen:
                raise row.fault(f"{row['observable']} of {row['test']} is in {seen[of]} already; state each run once")
            seen[of] = row.place
            value, u = row.number("value"), row.number("u", above=0)
            row.update(value=value, u=u)
            rows.append(row)
    return header, rows


def powers(rows):
    """Rows of `power`, loaded less idle, for runs that have both."""
    by_run = defaultdict(dict)
    for row in rows:
        by_run[row["test"]][row["observable"]] = row
    for of in by_run.values():
        if "power_loaded" in of and "power_idle" in of and "power" not in of:
            loaded, idle = of["power_loaded"], of["power_idle"]
            row = tables.Row(loaded, loaded.path, loaded.line)
            row.update(observable="power", value=loaded["value"] - idle["value"], u=math.hypot(loaded["u"], idle["u"]))
            yield row


def grouped(rows):
    """(test without its seed, observable) -> rows, whose conditions are equal"""
    groups = defaultdict(list)
    for row in rows:
        members = groups[(re.sub(r"_s\d+$", "", row["test"]), row["observable"])]
        members.append(row)
        first = members[0]
        differ = [c for c in row if c not in ("test", "value", "u") and row[c] != first[c]]
        if differ:
            raise row.fault(
                f"{differ[0]} is '{row[differ[0]]}', in {first.place} '{first[differ[0]]}': no seeds of one test; "
                "name runs under other conditions otherwise"
            )
    return groups


def mean(test, members, spread):
    n, middle = len(members), scatter.mean([m["value"] for m in members])
    of_run = max(spread * abs(middle), math.sqrt(scatter.mean([m["u"] ** 2 for m in members])))
    return dict(members[0], test=test, value=f"{middle:.6g}", u=f"{of_run / math.sqrt(n):.3g}")
