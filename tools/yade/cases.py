# SPDX-License-Identifier: GPL-2.0-or-later
"""Reads cases.json: every case with its defaults and materials filled in, or BadInput."""
from tools import files
from tools.errors import BadInput
from tools.yade import mapping

LAWS = ("ViscEl", "CohFrict")


def filled(book, raw, where):
    for key in ("law", "materials", "step", "end", "spheres"):
        if key not in raw:
            raise BadInput(f"{where}: no entry {key!r}")
    case = dict(book["defaults"], **raw)
    if case["law"] not in LAWS:
        raise BadInput(f"{where}: law {case['law']!r} is none of {', '.join(LAWS)}")
    if case["model"] not in mapping.PROPERTIES:
        raise BadInput(f"{where}: model {case['model']!r} is none of {', '.join(mapping.PROPERTIES)}")
    if case.get("wall", "box") not in mapping.WALL_RADIUS_FACTOR:
        raise BadInput(f"{where}: wall {case['wall']!r} is none of {', '.join(mapping.WALL_RADIUS_FACTOR)}")
    if len(case["spheres"]) != (1 if "wall" in case else 2):
        raise BadInput(f"{where}: {len(case['spheres'])} spheres; a case has one and a wall, or two")
    if not 0 < case["step"] < case["end"]:
        raise BadInput(f"{where}: step {case['step']} s and end {case['end']} s; 0 < step < end is needed")
    if case.get("press") and ("gravity" if "wall" in case else "force") not in case:
        raise BadInput(f"{where}: 'press' needs the gravity (wall) or the force (spheres) that presses")
    if len(case["materials"]) != 2:
        raise BadInput(f"{where}: {len(case['materials'])} materials; one for each of the two bodies is needed")
    for name in case["materials"]:
        if name not in book["materials"]:
            raise BadInput(f"{where}: no material {name!r}; there are {', '.join(book['materials'])}")
    # what a material does not name is 0: it takes no part in its cases
    unused = dict.fromkeys(mapping.PROPERTIES[case["model"]], 0)
    case["materials"] = [dict(unused, **book["materials"][m]) for m in case["materials"]]
    return case


def read(path, names):
    book = files.read_json(path, "give a file of cases with --cases")
    for key in ("limit", "samples", "materials", "defaults", "cases"):
        if key not in book:
            raise BadInput(f"{path}: no entry {key!r}")
    known = [c.get("name", "?") for c in book["cases"]]
    for name in names or []:
        if name not in known:
            raise BadInput(f"no case {name!r} in {path}; the cases are {', '.join(known)}")
    return book, [
        filled(book, c, f"{path}: case {c.get('name', '?')}")
        for c in book["cases"]
        if not names or c.get("name", "?") in names
    ]
