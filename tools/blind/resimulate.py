# SPDX-License-Identifier: GPL-2.0-or-later
"""Simulates the check tests of some withheld cases again, with `vielto` and `liggghts` on the PATH: does the gap close?

  scripts/blind resimulate [--share 0.5] [--draw 1] FOLDER/check/truth FOLDER/answers FOLDER/check/cases SEALED/isolability.json LIBRARY [OPTIONS]

Of the strong cases with one known effect whose answer is not "no gap" a share is drawn; which ones rests on --draw alone, and
a smaller share is the beginning of a larger one. The measured shrink goes into each answer, where gap-score finds it.
OPTIONS are those of vielto gap confirm. Killed at any moment, the same line goes on.
"""
import argparse
import math
import pathlib
import random
import subprocess

from tools.blind import cases
from tools.errors import BadInput, RunFailed
from tools.progress import Progress


def add_options(parser):
    parser.add_argument("--share", type=float, default=0.5, help="part of the cases, 0 to 1 (default 0.5)")
    parser.add_argument("--draw", type=int, default=1, help="of the random order (default 1)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
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
    progress = Progress("cases simulated again", len(chosen))
    for case in chosen:
        words = ["vielto", "gap", "confirm", options.cases / case / "observations.csv", "--library", options.library]
        words += ["--sealed", options.sealed, "--out", options.answers / case, "--jobs", options.jobs, "--run"]
        done = subprocess.run([str(word) for word in words] + options.options, stdout=subprocess.DEVNULL)
        if done.returncode:
            raise RunFailed(f"{options.cases / case}: could not be simulated again")
        progress.step()
