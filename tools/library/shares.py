# SPDX-License-Identifier: GPL-2.0-or-later
"""The paddle_share_* of a collected library's baseline as a law's table for `vielto gap discrepancy`.

  scripts/library shares findings/withheld_mixer/truth_hooke --wall steel --out libraries/laws/mixer_hooke_paddle.csv

For runs whose observations do not state them: the sectors of sources.csv (gap/library/sources.h) over their sum.
"""
import collections
import pathlib

from tools import tables
from tools.errors import BadInput

MEND = "name a folder made by vielto gap collect"
SECTORS = {"carried": "-120 to -60 deg", "entering": "-60 to 0 deg", "leaving": "60 to 120 deg"}
U = "0.001"  # not used: how runs scatter is in the runs


def add_options(parser):
    parser.add_argument("library", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--wall", default="", help="name of the wall that the rows are to state")
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="TABLE.csv")


def work(options):
    folder = options.library
    design = tables.read(folder / "design.csv", ["test", "effect"], MEND)
    baseline = {row["test"] for row in design if row["effect"] == "none"}
    of_run = {row["test"]: row for row in tables.read(folder / "observations.csv", ["test", "observable"], MEND)}
    torques = collections.defaultdict(dict)
    for row in tables.read(folder / "sources.csv", ["test", "kind", "source", "torque_Nm"], MEND):
        if row["kind"] == "phase" and row["test"] in baseline and row["test"] in of_run:
            torques[row["test"]][row["source"]] = row.number("torque_Nm")
    if not torques:
        raise BadInput(f"{folder}/sources.csv: holds no paddle's torque by sector of a baseline run; {MEND}")
    rows = []
    for test, sectors in sorted(torques.items()):
        whole = sum(sectors.values())
        for share, sector in SECTORS.items():
            row = dict(of_run[test], test=f"{folder.name}_{test}", observable=f"paddle_share_{share}")
            rows.append({**row, "value": f"{sectors[sector] / whole:.6g}", "u": U, "unit": "1", "wall": options.wall})
    tables.write(options.out, list(rows[0]), [list(row.values()) for row in rows])
