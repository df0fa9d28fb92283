# SPDX-License-Identifier: GPL-2.0-or-later
"""Truths of withheld cases and the answers that were given to them."""
import pathlib

from tools import files
from tools.errors import BadInput

MEND = "diagnose the cases first (scripts/blind diagnose)"


def add_options(parser):
    parser.add_argument("truths", type=pathlib.Path, help="FOLDER/check/truth")
    parser.add_argument("answers", type=pathlib.Path, help="FOLDER/answers")


def truths(folder):
    """The truth of each case, in the order of their names."""
    found = [files.read_json(path, "make the cases again with gap-withhold") for path in sorted(folder.glob("*.json"))]
    if not found:
        raise BadInput(f"{folder}: holds no truth; make cases with gap-withhold")
    return found


def answer(answers, case):
    """The diagnosis of a case."""
    path = answers / case / "diagnosis.json"
    given = files.read_json(path, MEND)
    if "verdict" not in given:
        raise BadInput(f"{path}: has no verdict; {MEND}")
    return given


def strong(folder, answers):
    """Names of the strong cases of one known effect that were not answered with "no gap": what can be simulated again."""
    known = [t["case"] for t in truths(folder) if t["kind"] == "known" and t["level"] == "strong"]
    return [case for case in known if answer(answers, case)["verdict"] != "no_gap"]
