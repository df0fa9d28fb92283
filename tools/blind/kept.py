# SPDX-License-Identifier: GPL-2.0-or-later
"""What runs of `vielto gap confirm` have shown, kept as a table, so that no session makes a run of another again.

A run is known by its command without the folder: cases that ask for the same command share its rows. The table rests on the
rig's files; its first rows state their hashes, and `vielto gap confirm` refuses what was made from others.
"""
import hashlib
import pathlib
import re
import shlex

from tools import files, tables
from tools.errors import BadInput

MEND = "remove it to make its runs anew"
PLACE = re.compile(r" -var (run|resume) [^ ]+")


def key_of(command):
    """Of the command that a run.json states: what is simulated, not where."""
    return hashlib.sha256(PLACE.sub("", command).encode()).hexdigest()[:16]


class Kept:
    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.header, self.rows, self.hashes = [], {}, {}
        if not self.path.exists():
            return
        table = tables.read(self.path, ["run", "test", "observable", "value"], MEND)
        self.header = table.header[1:]
        for row in table:
            if row["run"] == "file":
                self.hashes[row["test"]] = row["observable"]
            else:
                self.rows.setdefault(row["run"], []).append(row)

    def give(self, plan):
        """Lays what is kept of a plan's commands (`vielto gap confirm` prints them) where the plan looks for its runs."""
        for line in plan.splitlines():
            words = shlex.split(line.strip("()"))
            if "liggghts" not in words:
                continue
            simulated = words[words.index("liggghts") :]
            simulated = simulated[: simulated.index("&&")] if "&&" in simulated else simulated
            run = next(
                pathlib.Path(value)
                for var, name, value in zip(simulated, simulated[1:], simulated[2:])
                if (var, name) == ("-var", "run")
            )
            command = " ".join(simulated)
            rows = self.rows.get(key_of(command))
            if not rows or (run / "post/observations.csv").exists():
                continue
            (run / "post").mkdir(parents=True, exist_ok=True)
            files.write_json(run / "run.json", {"command": command, "hashes": self.hashes})
            tables.write(run / "post/observations.csv", self.header, rows)

    def take(self, runs, observables):
        """The rows of these observables of all complete runs of a folder, into the table."""
        for description in sorted(pathlib.Path(runs).glob("*/run.json")):
            made = files.read_json(description, "make the run again")
            shown = description.parent / "post/observations.csv"
            key = key_of(made["command"])
            if key in self.rows or not shown.exists():
                continue
            if self.hashes and made["hashes"] != self.hashes:
                raise BadInput(f"{self.path}: was made from other files than {description.parent}; {MEND}")
            table = tables.read(shown, ["test", "observable", "value"], "make the run again")
            self.hashes, self.header = made["hashes"], table.header
            self.rows[key] = [row for row in table if row["observable"] in observables]
        self.write()

    def write(self):
        header = ["run", *self.header]
        rows = [{"run": "file", "test": name, "observable": hash_} for name, hash_ in self.hashes.items()]
        rows += [{"run": key, **row} for key, of_run in self.rows.items() for row in of_run]
        tables.write(self.path, header, rows)
