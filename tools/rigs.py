# SPDX-License-Identifier: GPL-2.0-or-later
"""The one table of rigs, cases/rigs.toml, which says what its keys mean, and tables of the same form for rigs of one's own."""
import pathlib
import re

from tools import ROOT, files
from tools.errors import BadInput

TABLE = ROOT / "cases/rigs.toml"


class Rig:
    def __init__(self, name, stated, folder):
        self.name = name
        self.script = folder / stated["script"]
        self.parameters = [folder / path for path in stated.get("parameters", [])]
        self.record = stated.get("record")
        self.post = stated.get("post", "")
        self.result = stated.get("result")
        self.reference = stated.get("reference")
        self._work = stated.get("work", "0")
        self._defaults = None

    def defaults(self):
        """Every -var and its baseline value, as text. As in LIGGGHTS, what is stated first holds."""
        if self._defaults is None:
            self._defaults = {}
            for path in self.parameters:
                for name, value in re.findall(r"^variable (\w+) index (\S+)", path.read_text(), re.M):
                    self._defaults.setdefault(name, value)
        return self._defaults

    def work(self, settings):
        """Relative cost of a run with these -var: bulk volume of the grains times simulated time (`work`), over the fourth
        power of the grain's diameter, for their number and the time step, times the root of their stiffness, for the time
        step. 0 for settings with which there is no such run: the rig will say so."""
        values = {name: _number(value) for name, value in {**self.defaults(), **settings}.items()}
        try:
            volume_time = eval(self._work, {"__builtins__": {}, "min": min, "max": max}, _Names(values))
            cost = volume_time / values["grainDiameter"] ** 4 * values["youngsModulus"] ** 0.5
            return max(0.0, float(cost))
        except (ArithmeticError, KeyError, SyntaxError, TypeError, ValueError):
            return 0.0


# Of one core of 2 GHz: the mixer of 8 mm grains takes 20 minutes, of 12 mm 4 (doc/reference/cost.md). Another rig has another
# share of walls and of time that grain falls freely, so that this holds to a factor of two.
SECONDS_OF_WORK = 4.5e-7


class _Names(dict):
    """A -var that is not given is 0, as a column that a study has not."""

    def __missing__(self, name):
        if name in ("min", "max"):
            raise KeyError(name)
        return 0.0


def _number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text  # a word, true unless empty


def read(own=None):
    """{name: Rig} of the table, and of a table of one's own."""
    rigs = {}
    for path in filter(None, (TABLE, own)):
        path = pathlib.Path(path).resolve()
        for name, stated in files.read_toml(path, "give a table in the form of cases/rigs.toml").items():
            if name in rigs:
                raise BadInput(f"{path}: {name} is the name of a rig that there is; name it otherwise")
            if isinstance(stated, dict) and "script" in stated:
                rigs[name] = Rig(name, stated, path.parent)
    return rigs
