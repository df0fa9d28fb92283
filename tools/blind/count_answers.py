# SPDX-License-Identifier: GPL-2.0-or-later
"""What was answered to each kind of withheld case, as a table: kind, effect, strength, answer, cases.

  scripts/blind count-answers FOLDER/check/truth FOLDER/answers --out verdicts.csv

A named effect or pair stands after "named", the members of an ambiguous answer after "ambiguous", in the order of their names.
"""
import collections
import pathlib

from tools import tables
from tools.blind import cases


def add_options(parser):
    cases.add_options(parser)
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="TABLE.csv")


def work(options):
    counted = collections.Counter()
    for truth in cases.truths(options.truths):
        given = cases.answer(options.answers, truth["case"])
        words = {"named": given["named"], "ambiguous": given["group"]}.get(given["verdict"], [])
        told = " ".join([given["verdict"], *sorted(words)])
        counted[truth["kind"], "+".join(sorted(truth["effects"])), truth["level"], told] += 1
    header = ["kind", "effect", "strength", "answer", "cases"]
    tables.write(options.out, header, [(*case, n) for case, n in sorted(counted.items())])
