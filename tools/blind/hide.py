# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs a command while paths lie out of its reach.

  scripts/blind hide PATH... -- COMMAND...

The paths (base truths, truth files, seals) lie in a folder that this program alone knows while the command runs, and come
back when it ends, however it ends but by kill -9, after which they are in the newest folder /tmp/vielto-hidden-*.
"""
import argparse
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile

from tools.errors import BadInput


def add_options(parser):
    parser.add_argument("words", nargs=argparse.REMAINDER, metavar="PATH... -- COMMAND...")


def work(options):
    paths, command = split(options.words)
    for path in paths:
        if not os.path.lexists(path):
            raise BadInput(f"there is no {path} to hide; run the step that makes it first")
    ending = Ending()
    hidden = tempfile.mkdtemp(prefix="vielto-hidden-")
    moved = []
    try:
        for k, path in enumerate(paths):
            moved.append((path, os.path.join(hidden, str(k))))
            shutil.move(*moved[-1])
        return run(command, ending)
    finally:
        for path, place in moved:
            if os.path.lexists(place):
                shutil.move(place, path)
        os.rmdir(hidden)


def split(words):
    if "--" not in words:
        raise BadInput("there is no -- before the command; usage: blind hide PATH... -- COMMAND...")
    at = words.index("--")
    paths, command = [pathlib.Path(w) for w in words[:at]], words[at + 1 :]
    if not paths or not command:
        raise BadInput("needs paths to hide and a command; usage: blind hide PATH... -- COMMAND...")
    return paths, command


class Ending:
    """Told to end, the command and all that it started ends before anything comes back."""

    def __init__(self):
        self.told, self.process = 0, None
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
            signal.signal(number, self.end)

    def end(self, number, _=None):
        self.told = number
        if self.process:
            os.killpg(self.process.pid, signal.SIGTERM)


def run(command, ending):
    """The command's exit status, or that of a program that was told to end."""
    try:
        ending.process = subprocess.Popen(command, start_new_session=True)
    except OSError as e:
        raise BadInput(f"{command[0]}: {e.strerror}; name a program")
    if ending.told:  # before it could be passed on
        ending.end(ending.told)
    status = ending.process.wait()
    if ending.told:
        return 128 + ending.told
    return 128 - status if status < 0 else status
