# SPDX-License-Identifier: GPL-2.0-or-later
"""Plans of calibrations: what is calibrated, on which runs, against which targets."""
import math
import pathlib

from tools import files
from tools.errors import BadInput

EXAMPLE = "see materials/hulled_millet.calibration.toml"


def is_number(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool) and math.isfinite(x)


def read(path):
    plan = files.read_toml(path, f"name a plan, {EXAMPLE}")
    plan["path"] = path

    def refuse(what):
        raise BadInput(f"{path}: {what}; {EXAMPLE}")

    for key in ("members", "points", "parameter", "vars", "run", "target"):
        if key not in plan:
            refuse(f"there is no `{key}`")
    for key in ("members", "points"):
        if not isinstance(plan[key], int) or plan[key] < 1:
            refuse(f"{key} is {plan[key]!r}, no whole number above 0")
    for kind, texts, numbers in (
        ("parameter", ("name",), ("low", "high")),
        ("run", ("name", "rig"), ()),
        ("target", ("run", "column", "u_column"), ("value", "u")),
    ):
        for entry in plan[kind]:
            for key in texts:
                if not isinstance(entry.get(key), str):
                    refuse(f"a [[{kind}]] has no text `{key}`")
            for key in numbers:
                if not is_number(entry.get(key)):
                    refuse(f"[[{kind}]] {entry.get('name') or entry.get('run')}: `{key}` is no number")
    for p in plan["parameter"]:
        if not p["low"] < p["high"] or (p.get("scale") == "log" and p["low"] <= 0):
            refuse(f"parameter {p['name']}: needs low < high, and low > 0 on a log scale")
        if "sd" in p and not (is_number(p["sd"]) and p["sd"] > 0 and is_number(p.get("mean"))):
            refuse(f"parameter {p['name']}: a normal prior needs a mean and an sd above 0")
    for target in plan["target"]:
        if not target["u"] > 0:
            refuse(f"target {target['run']}: u is {target['u']:g}, no standard uncertainty")
    runs = {run["name"] for run in plan["run"]}
    for wanted in [*plan["target"], *plan.get("report", [])]:
        if wanted["run"] not in runs:
            refuse(f"target {wanted['run']}: there is no [[run]] of that name")
    middle = [0.5] * len(plan["parameter"])
    try:
        for run in plan["run"]:
            if not all(is_number(v) for v in variables(plan, middle, run).values()):
                refuse(f"vars of {run['name']}: an expression gives no number")
        possible(plan, middle)
    except BadInput:
        raise
    except Exception as e:  # whatever Python says of an expression of the plan
        refuse(f"an expression of `vars` or `where` does not work ({e})")
    return plan


def to_value(parameter, unit):
    low, high = parameter["low"], parameter["high"]
    if parameter.get("scale") == "log":
        return low * (high / low) ** unit
    return low + (high - low) * unit


def to_unit(parameter, value):
    low, high = parameter["low"], parameter["high"]
    if parameter.get("scale") == "log":
        return math.log(value / low) / math.log(high / low)
    return (value - low) / (high - low)


def variables(plan, point, run=None):
    """The -var of one point: expressions of the plan, which are Python with the parameters' names; with those of `run` alone."""
    values = {p["name"]: to_value(p, u) for p, u in zip(plan["parameter"], point)}
    texts = {**plan["vars"], **(run or {}).get("vars", {})}
    return {name: eval(text, {"__builtins__": {}, "math": math}, values) for name, text in texts.items()}


def possible(plan, point):
    """Whether the plan's `where`, an expression of the parameters, holds; no prior probability lies elsewhere."""
    values = {p["name"]: to_value(p, u) for p, u in zip(plan["parameter"], point)}
    return bool(eval(plan.get("where", "True"), {"__builtins__": {}, "math": math}, values))


def sobol(dimension, size):
    import openturns as ot

    return [list(x) for x in ot.SobolSequence(dimension).generate(size)]


def points(plan):
    """Of the design, in the unit cube."""
    return sobol(len(plan["parameter"]), plan["points"])


def wanted(plan):
    """What is emulated: the targets, and what is only reported."""
    return [*plan["target"], *plan.get("report", [])]


def writable(text):
    """A path in a folder that is there; said before any work."""
    path = pathlib.Path(text)
    if not path.absolute().parent.is_dir() or path.is_dir():
        raise BadInput(f"{path}: cannot be written; state a file in a folder that is there")
    return path
