# SPDX-License-Identifier: GPL-2.0-or-later
"""An answer for every withheld case, with `vielto` on the PATH.

  scripts/blind diagnose [--jobs N] FOLDER/check/cases FOLDER/answers SEALED/isolability.json LIBRARY [OPTIONS of vielto gap diagnose]

The sealed threshold holds for cases without removed effects; the others get one of their own. Cases that are answered are
not done again. The time left is told once a minute.
"""
import argparse
import concurrent.futures
import os
import pathlib
import subprocess

from tools import files
from tools.errors import BadInput, RunFailed
from tools.progress import Progress


def add_options(parser):
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count(), help="cases at a time; default: the machine's cores"
    )
    parser.add_argument("cases", type=pathlib.Path)
    parser.add_argument("answers", type=pathlib.Path)
    parser.add_argument("sealed", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("options", nargs=argparse.REMAINDER, help="of vielto gap diagnose")


def work(options):
    every = sorted(path for path in options.cases.glob("*/") if path.is_dir())
    if not every:
        raise BadInput(f"{options.cases}: holds no case; make cases with gap-withhold")
    waiting = [case for case in every if not (options.answers / case.name / "diagnosis.json").exists()]
    progress = Progress("cases diagnosed", len(waiting))
    with concurrent.futures.ThreadPoolExecutor(max(1, options.jobs)) as pool:
        try:
            for _ in pool.map(lambda case: diagnose(case, options), waiting):
                progress.step()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def diagnose(case, options):
    removed = files.read_json(case / "case.json", "make the cases again with gap-withhold").get("without", [])
    how = ["--without", ",".join(removed)] if removed else ["--sealed", options.sealed]
    words = ["vielto", "gap", "diagnose", case / "observations.csv", "--library", options.library]
    words += ["--out", options.answers / case.name, *how, *options.options]
    done = subprocess.run(words, stdout=subprocess.DEVNULL)
    if done.returncode:
        raise RunFailed(f"{case}: could not be diagnosed")
    (options.answers / case.name / "diagnosis.html").unlink()  # a megabyte each, which nobody reads
