# SPDX-License-Identifier: GPL-2.0-or-later
"""The study of a plan: points of a Sobol sequence over the ranges of its parameters, each one run of every rig.

Points where the plan's `where` does not hold are left out.
"""
import pathlib

from tools import tables
from tools.calibration import plans


def add_options(parser):
    parser.add_argument("plan", type=pathlib.Path)
    parser.add_argument("--out", type=plans.writable, required=True, metavar="STUDY.csv")


def work(options):
    plan = plans.read(options.plan)
    settings = list(dict.fromkeys(key for run in plan["run"] for key in run.get("settings", {})))
    names = list(dict.fromkeys([*plan["vars"], *(key for run in plan["run"] for key in run.get("vars", {}))]))
    rows = []
    for k, point in enumerate(plans.points(plan), 1):
        for run in plan["run"] if plans.possible(plan, point) else ():
            made = {name: f"{value:.6g}" for name, value in plans.variables(plan, point, run).items()}
            rows.append({"run": f"{run['name']}_{k}", "rig": run["rig"], "seed": k, **run.get("settings", {}), **made})
    tables.write(options.out, ["run", "rig", "seed", *settings, *names], rows)
