# SPDX-License-Identifier: GPL-2.0-or-later
"""Adds the runs of a campaign to a response library whose other runs were made earlier, perhaps on another machine.

  scripts/library add PLAN.toml RESULTS LIBRARY          with `vielto` on the PATH, from the repository's root

RESULTS is a campaign's folder with some of the plan's runs; LIBRARY holds others. Afterwards LIBRARY holds both, as `vielto
gap collect` would have made it of all, without the runs that the plan has no longer.

Runs of an effect that changes something else in the rig now than it did then (effects.csv) are taken out.

Stale library: if files that its runs were made from have changed since, the new portion must repeat some of its runs (two or
more), with the same numbers to the last digit. Then the change makes no difference to the runs and the library takes the files'
new hashes; else it is refused, and the campaign must be run anew.
"""
import pathlib
import subprocess
import tempfile

from tools import tables
from tools.errors import BadInput

LEAST_REPEATED = 2
MEND = "make the library with vielto gap collect"


def add_options(parser):
    parser.add_argument("plan", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--effects", type=pathlib.Path, help="without it effects/ beside the library")


class Portion:
    """The tables of a library's folder: {name: (header, {test: rows})}, and what its runs were made from."""

    def __init__(self, folder):
        self.folder, self.tables = folder, {}
        for name in ("design.csv", "observations.csv", "sources.csv", "bench.csv"):
            if (folder / name).exists():
                table = tables.read(folder / name, ["test"], MEND, may_be_empty=True)
                by_test = {}
                for row in table:
                    by_test.setdefault(row["test"], []).append(row)
                self.tables[name] = table.header, by_test
        self.effects = {(r["effect"], r["rig"]): r["changes"] for r in self._optional("effects.csv", ["effect", "rig"])}

    def _optional(self, name, columns):
        path = self.folder / name
        return tables.read(path, columns, MEND, may_be_empty=True) if path.exists() else []

    def hashes(self):
        rows = tables.read(self.folder / "inputs.csv", ["file", "sha256"], MEND)
        return {row["file"]: row["sha256"] for row in rows}

    def rows(self, name):
        return self.tables[name][1]

    def drop(self, redefined):
        """Takes the runs of these (effect, rig) out of the tables; their number."""
        gone = {
            test
            for test, rows in self.rows("design.csv").items()
            for effect, rig in redefined
            if rows[0]["effect"] == effect and test.startswith(rig)
        }
        for _, rows in self.tables.values():
            for test in gone:
                rows.pop(test, None)
        return len(gone)


def work(options):
    effects = ["--effects", options.effects] if options.effects else []
    library = options.library
    wanted = planned(options.plan, effects)
    # beside the library: its inputs are paths from its folder
    with tempfile.TemporaryDirectory(dir=library.parent) as scratch:
        vielto("collect", options.plan, options.results, "--out", scratch, *effects)
        fresh, old = Portion(pathlib.Path(scratch)), Portion(library)
        check_kind(fresh, old)
        redefined = {of for of, changes in old.effects.items() if fresh.effects.get(of, changes) != changes}
        dropped = old.drop(redefined)
        repeated, changed = check_repeated(fresh, old, wanted)
        write(fresh, old, wanted)
    runs = set(fresh.rows("design.csv")) & wanted
    total = len({t for t in old.rows("design.csv") if t in wanted} | runs)
    told = f"{library}: {len(runs - set(repeated))} runs added, {total} of {len(wanted)} in all"
    if changed:
        told += f"; {len(repeated)} repeated with the same numbers, so that {', '.join(changed)} made no difference"
    if dropped:
        told += f"; {dropped} of {', '.join(sorted({e for e, _ in redefined}))} taken out: the effect was another then"
    print(told)


def vielto(*words):
    try:
        done = subprocess.run(["vielto", "gap", *map(str, words)], capture_output=True, text=True)
    except FileNotFoundError:
        raise BadInput(
            "there is no `vielto` on the PATH; build it (scripts/build release vielto) and put build/bin there"
        )
    if done.returncode:
        raise BadInput((done.stderr or done.stdout).strip())


def planned(plan, effects):
    """Names of the plan's runs, as a table of vielto gap plan has them, and of its bench rows."""
    with tempfile.TemporaryDirectory() as folder:
        study = pathlib.Path(folder) / "study.csv"
        vielto("plan", plan, "--out", study, *effects)
        return {row["run"] for row in tables.read(study, ["run"], "state a plan with runs")}


def check_kind(fresh, old):
    if "design.csv" not in old.tables:
        raise BadInput(f"{old.folder} is no response library; make the first portion with vielto gap collect")
    if fresh.tables["design.csv"][0] != old.tables["design.csv"][0]:
        raise BadInput(f"{old.folder / 'design.csv'} has other parameters than the plan's family; collect it anew")


def check_repeated(fresh, old, wanted):
    """(runs that both hold, files that have changed since): the same numbers, and enough of them where files changed."""
    now, then = fresh.hashes(), old.hashes()
    changed = sorted(f for f in then.keys() | now.keys() if then.get(f) != now.get(f))
    runs = set(fresh.rows("design.csv")) & wanted
    new, known = fresh.rows("observations.csv"), old.rows("observations.csv")
    repeated = sorted(runs & set(known))
    differ = [t for t in repeated if new[t] != known[t]]
    if differ:
        raise BadInput(
            f"run {differ[0]} ({len(differ)} of {len(repeated)}) has other numbers than the library's: the runs were made "
            f"from other files ({', '.join(changed) or 'none listed'}) or on a machine that rounds otherwise; run the campaign anew"
        )
    if changed and len(repeated) < LEAST_REPEATED:
        raise BadInput(
            f"the library was made from other files ({', '.join(changed)}): repeat {LEAST_REPEATED} of its runs or more, to show "
            f"that they make no difference; {len(repeated)} repeated"
        )
    return repeated, changed


def write(fresh, old, wanted):
    library = old.folder
    for name, (header, now) in fresh.tables.items():
        before = {} if name == "bench.csv" else old.tables.get(name, (header, {}))[1]
        bench = {test: rows for test, rows in now.items() if test.startswith("bench_")}
        merged = {test: rows for test, rows in before.items() if test in wanted and test not in now}
        merged.update({test: rows for test, rows in now.items() if test not in bench})
        ordered = [row for test in sorted(merged, key=order) for row in merged[test]]
        tables.write(library / name, header, ordered + [row for rows in bench.values() for row in rows])
    effects = {**old.effects, **fresh.effects}
    tables.write(
        library / "effects.csv", ["effect", "rig", "changes"], [(*of, text) for of, text in sorted(effects.items())]
    )
    for name in ("posterior.csv", "inputs.csv"):
        if (fresh.folder / name).exists():
            table = tables.read(fresh.folder / name, [], MEND)
            tables.write(library / name, table.header, table)


def order(test):
    """Baseline and members of the family first; condition, then effect, then seed: mixer1_none_s1"""
    rig, _, rest = test.partition("_")
    label, _, seed = rest.rpartition("_s")
    return (
        label.split("_")[0] != "none",
        not label.startswith("member"),
        rig,
        label,
        int(seed) if seed.isdigit() else 0,
    )
