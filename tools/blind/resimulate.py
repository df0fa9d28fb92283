# SPDX-License-Identifier: GPL-2.0-or-later
"""Simulates the check tests of some withheld cases again, with `vielto` and `liggghts` on the PATH: does the gap close?

  scripts/blind resimulate [--share 0.5] [--draw 1] [--kept TABLE] FOLDER/check/truth FOLDER/answers FOLDER/check/cases
      SEALED/isolability.json LIBRARY [OPTIONS]

Of the strong cases with one known effect whose answer is not "no gap" a share is drawn; which ones rests on --draw alone, and
a smaller share is the beginning of a larger one. The measured shrink goes into each answer, where gap-score finds it.
OPTIONS are those of vielto gap confirm. Killed at any moment, the same line goes on. TABLE keeps what each run has shown
(kept.py): a run that it holds is not made again, in this folder or in another.
"""
import argparse
import math
import pathlib
import random
import subprocess

from tools import tables
from tools.blind import cases
from tools.blind.kept import Kept
from tools.errors import BadInput, RunFailed
from tools.progress import Progress


def add_options(parser):
    parser.add_argument("--share", type=float, default=0.5, help="part of the cases, 0 to 1 (default 0.5)")
    parser.add_argument("--draw", type=int, default=1, help="of the random order (default 1)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--kept", type=pathlib.Path, help="table of what runs have shown, taken up and added to")
    cases.add_options(parser)
    parser.add_argument("cases", type=pathlib.Path)
    parser.add_argument("sealed", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("options", nargs=argparse.REMAINDER, help="of vielto gap confirm")


def drawn(strong, share, draw):
    if not 0 < share <= 1:
        raise BadInput(f"--share {share:g} is out of range; state a part from over 0 to 1")
    return random.Random(draw).sample(strong, len(strong))[: math.ceil(share * len(strong))]


def work(options):
    chosen = drawn(cases.strong(options.truths, options.answers), options.share, options.draw)
    print("simulated again:", *chosen, flush=True)
    kept = Kept(options.kept) if options.kept else None
    progress = Progress("cases simulated again", len(chosen))
    for case in chosen:
        table = options.cases / case / "observations.csv"
        words = ["vielto", "gap", "confirm", table, "--library", options.library]
        words += ["--sealed", options.sealed, "--out", options.answers / case, "--jobs", options.jobs]
        words = [str(word) for word in [*words, *options.options]]
        if kept:
            kept.give(confirm(words, table, stdout=subprocess.PIPE))
        confirm([*words, "--run"], table, stdout=subprocess.DEVNULL)
        if kept:
            kept.take(options.answers / case / "runs", checked(table))
        progress.step()


def confirm(words, table, stdout):
    done = subprocess.run(words, stdout=stdout, text=True)
    if done.returncode:
        raise RunFailed(f"{table.parent}: could not be simulated again")
    return done.stdout


def checked(table):
    """The observables of a case's check tests."""
    return {
        row["observable"]
        for row in tables.read(table, ["role", "observable"], "make the case again")
        if row["role"] == "check"
    }
