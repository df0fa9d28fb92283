#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""doc/guide/measured_against_simulated.md does what it says: every line after `$` is run, in order, and the lines under it come out, in order.

  tutorial_test.py BIN        folder of vielto
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
page = (root / "doc/guide/measured_against_simulated.md").read_text()
steps = []  # command, lines that must come out
for block in re.findall(r"^ *```\n(.*?)^ *```", page, re.M | re.S):
    for line in block.splitlines():
        line = line.strip()
        if line.startswith("$ "):
            steps.append((line[2:], []))
        elif line and steps:
            steps[-1][1].append(line)
assert len(steps) > 8, "the tutorial's commands were not found"

with tempfile.TemporaryDirectory(prefix="vielto-tutorial-") as name:
    for folder in ("cases", "findings", "libraries", "liggghts_addons", "materials", "scripts", "studies", "tools"):
        (pathlib.Path(name) / folder).symlink_to(root / folder)
    environment = {**os.environ, "PATH": f"{sys.argv[1]}:{os.environ['PATH']}"}
    for command, expected in steps:
        done = subprocess.run(["bash", "-c", command], cwd=name, env=environment, capture_output=True, text=True)
        said = done.stdout + done.stderr
        assert done.returncode == 0, f"{command}\n{said}"
        at = 0
        for line in expected:
            found = said.find(line, at)
            assert found >= 0, f"{command}\nshould say: {line}\nsays:\n{said}"
            at = found + len(line)
print(len(steps), "commands of the tutorial")
