# SPDX-License-Identifier: GPL-2.0-or-later
"""Packages and programs that the comparisons with Yade need."""
import pathlib
import shutil
import subprocess

from tools import ROOT
from tools.errors import BadInput


def prepare(liggghts, yade):
    """Installs and builds what is missing; the liggghts to take. A program that was asked for by name has to be there."""
    subprocess.run([ROOT / "scripts/install-packages", "yade"], check=True)
    if not liggghts:
        liggghts = str(ROOT / "build/bin/liggghts")
        subprocess.run([ROOT / "scripts/install-packages", "demo"], check=True)
        subprocess.run([ROOT / "scripts/build", "release", "vielto_run"], check=True, stdout=subprocess.DEVNULL)
    for option, program in (("--liggghts", liggghts), ("--yade", yade)):
        if not shutil.which(program):
            raise BadInput(f"no program {program!r}; give it with {option}")
    # they are started in other folders
    return str(pathlib.Path(shutil.which(liggghts)).absolute())
