# SPDX-License-Identifier: GPL-2.0-or-later
"""A study: a table of runs, `run,rig` and one column for each -var that is not the rig's default (an empty cell is the
default). The column `bed` names another run of the study, whose bed is taken."""
import re

from tools import ROOT, tables
from tools.errors import BadInput

MEND = "give `run,rig` and one column for each -var"


def find(name):
    """The table of a study of that name in studies/, or at that path."""
    path = ROOT / "studies" / (name + ".csv")
    if not name.endswith(".csv") and path.is_file():
        return path
    if not name.endswith(".csv"):
        known = sorted(p.stem for p in (ROOT / "studies").glob("*.csv"))
        raise BadInput(f"there is no study {name}; known: {', '.join(known)}")
    return name


def read(path, rigs):
    """Its runs, checked against {name: rig}: each row {column: cell} without the empty cells."""
    table = tables.read(path, ["run", "rig"], MEND, key="run")
    names = {row["run"] for row in table}
    for row in table:
        if not row["run"] or row["rig"] not in rigs:
            raise row.fault(f"a run needs a name in `run` and one of {', '.join(rigs)} in `rig`")
        if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]*", row["run"]) or row["run"].startswith("idle_"):
            raise row.fault(
                f"'{row['run']}' is no name for a run; use letters, digits, '.', '_' and '-', and not idle_ in front"
            )
        if row.get("bed") and row["bed"] not in names:
            raise row.fault(f"bed {row['bed']} is no run of this study; name the run whose bed is taken")
    return [{column: cell for column, cell in row.items() if cell} for row in table]


def with_what_they_need(study, only):
    """{run: its row} of the runs whose names end in `only`, the runs whose beds they take, and for mixers the empty machine
    at their speed; {mixer run: its idling run}."""
    every = {point["run"]: point for point in study}
    points = {run: point for run, point in every.items() if run.endswith(only)}
    points.update({p["bed"]: every[p["bed"]] for p in points.values() if "bed" in p})
    idle_of = {run: f"idle_{p.get('speed', 'default')}" for run, p in points.items() if p["rig"] == "mixer"}
    for run, idle in list(idle_of.items()):
        # no grain, so neither grain size nor fill matter, and noise of its own
        speed = {"speed": points[run]["speed"]} if "speed" in points[run] else {}
        points.setdefault(idle, dict(run=idle, rig="mixer", fill="0", seed="2", turns="6", **speed))
    return points, idle_of
