# SPDX-License-Identifier: GPL-2.0-or-later
"""The rigs as scripts need them: names, result file, default values, and what a run costs."""
import functools
import re

from tools import ROOT

RESULT = {"mixer": "power", "shearbox": "shear", "repose": "repose", "drum": "drum"}  # post/NAME.json of a rig
NAMES = tuple(RESULT)


@functools.cache
def defaults(rig):
    """The rig's parameters as its file has them."""
    return dict(re.findall(r"^variable (\w+) index (\S+)", (ROOT / "cases" / rig / f"{rig}.par").read_text(), re.M))


def work(point):
    """Relative cost of a run: its grains times its steps, told from the rig's parameters. 0 where there is no such run:
    the rig will say so."""
    try:
        return max(0.0, float(_cost(point)))
    except (ValueError, ZeroDivisionError, TypeError, OverflowError):
        return 0.0


def _cost(point):
    def get(name, other=0.0):
        return float(point.get(name) or defaults(point["rig"]).get(name) or other)

    if point["rig"] == "mixer":
        drum = get("drumLength") * (get("slicePaddles") / get("paddleCount") or 1) * 0.062  # m3, of its section
        grain, seconds = drum * max(get("fill"), 0.01), get("turns") / get("speed")
    elif point["rig"] == "shearbox":
        grain = get("boxLength") * get("boxWidth") * get("boxHeight")
        seconds = get("displacement") / get("shearVelocity")
        seconds += 0 if point.get("bed") else get("settleTime") + get("loadTime")
    elif point["rig"] == "repose":
        grain = get("cylinderDiameter") ** 2 * get("fillHeight")
        seconds = get("settleTime") + get("fillHeight") / get("liftSpeed")
    else:
        grain, seconds = get("drumDiameter") ** 2 * get("drumLength") * get("fill"), get("settleTime")
        seconds += (get("startAngle") + get("frames") * get("frameAngle")) / 360 / get("speed")
    return grain * seconds / get("grainDiameter") ** 4 * get("youngsModulus", 2e6) ** 0.5
