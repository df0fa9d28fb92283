# SPDX-License-Identifier: GPL-2.0-or-later
"""How far from nothing each effect is seen, by one set of tests beside another.

  scripts/library detectability power=FOLDER 'and bench'=FOLDER --out detectability.csv

Each FOLDER holds an isolability.json of `vielto gap isolability`. A cell is the greatest distance of an effect's responses
from those of no effect, in standard deviations (calibration, law, library, seeds, measurement); an effect whose distance is
over the threshold is detectable, bold in what is printed. The last column names the effects that it may be taken for at its
best strength, by the last set of tests.
"""
import argparse
import pathlib

from tools import files, tables


def add_options(parser):
    parser.add_argument("sets", nargs="+", type=name_and_folder, metavar="NAME=FOLDER")
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="TABLE.csv")


def name_and_folder(text):
    name, equals, folder = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"'{text}' is no NAME=FOLDER")
    return name, pathlib.Path(folder)


def work(options):
    mend = "make it with vielto gap isolability"
    found = {name: files.read_json(folder / "isolability.json", mend) for name, folder in options.sets}
    last = found[options.sets[-1][0]]
    rows, told = [], []
    for effect in sorted(last["effects"], key=lambda e: -last["summary"][e]["from_nothing"]):
        cells = [cell(of, effect) for of in found.values()]
        taken = taken_for(last, effect)
        rows.append([effect, *(text for text, _ in cells), " ".join(taken)])
        bold = [f"**{text}**" if detectable else text or "–" for text, detectable in cells]
        told.append([f"`{effect}`", *bold, ", ".join(f"`{e}`" for e in taken) or "–"])
    header = ["effect", *found, "may be taken for"]
    tables.write(options.out, header, rows)
    for row in (header, ["---"] * len(header), *told):
        print("| " + " | ".join(row) + " |")


def cell(of, effect):
    """(distance, whether it is detectable); nothing where the set's tests cannot show the effect"""
    summary = of["summary"].get(effect)
    return (f"{summary['from_nothing']:.1f}", is_detectable(of, effect)) if summary else ("", False)


def is_detectable(of, effect):
    return of["summary"][effect]["from_nothing"] > of["detectable_distance"]


def taken_for(of, effect):
    return of["summary"][effect]["group"][1:] if is_detectable(of, effect) else []
