# SPDX-License-Identifier: GPL-2.0-or-later
"""Makes the rigs' reference files anew, cases/RIG/reference.csv: some seeds of coarse runs.

  scripts/reference          twenty minutes of one core; after a change of law, card or rig that is meant to change results
  scripts/reference silo     of one rig

What is run, and which numbers are kept, stands in cases/rigs.toml; tests/rigs/rig_reference_test.cpp compares one more seed
with them.
"""
import subprocess

from tools import ROOT, rigs, tables
from tools.errors import BadInput

TESTED_SEED = 9


def study(rig):
    """The runs of a rig, as a study's rows."""
    seeds = [s for s in range(1, rig.reference["seeds"] + 2) if s != TESTED_SEED][: rig.reference["seeds"]]
    return [
        {"run": f"{case}_s{seed}", "rig": rig.name, "seed": seed, **settings}
        for case, settings in rig.reference["cases"].items()
        for seed in seeds
    ]


def with_reference():
    return {name: rig for name, rig in rigs.read().items() if rig.reference}


def add_options(parser):
    parser.add_argument("rig", nargs="*", metavar="RIG", help=f"{', '.join(with_reference())}; without it all")


def work(options):
    kept = with_reference()
    for name in options.rig:
        if name not in kept:
            raise BadInput(f"{name} is no rig with a reference; name one of {', '.join(kept)}")
    for name in options.rig or kept:
        make(kept[name], ROOT / "results" / "reference" / name)


def make(rig, out):
    rows = study(rig)
    out.mkdir(parents=True, exist_ok=True)
    tables.write(out / "study.csv", list(dict.fromkeys(column for row in rows for column in row)), rows)
    subprocess.run([ROOT / "scripts/campaign", out / "study.csv", "--out", out], check=True)
    numbers = rig.reference["numbers"]
    made = {row["run"]: row for row in tables.read(out / "runs.csv", ["run", *numbers], "remove the folder")}
    path = rig.script.parent / "reference.csv"
    tables.write(
        path,
        ["case", "seed", *numbers],
        [
            [row["run"].rsplit("_s", 1)[0], row["seed"], *(f"{float(made[row['run']][n]):.6g}" for n in numbers)]
            for row in rows
        ],
    )
    print(path.relative_to(ROOT))
