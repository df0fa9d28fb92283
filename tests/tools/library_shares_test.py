#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/library shares: sectors over their sum, of baseline runs only; and the committed table is what it makes."""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools.library import shares as shares_module  # noqa: E402

OBSERVATIONS = "test,role,apparatus,observable,value,u,unit,speed,fill,wall\n"
SECTORS = [f"{a} to {a + 60} deg" for a in range(-180, 180, 60)]


def shares(*words):
    return subprocess.run(list(map(str, (ROOT / "scripts/library", "shares", *words))), capture_output=True, text=True)


class Shares(unittest.TestCase):
    def setUp(self):
        self.here = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.here.name) / "law"
        self.folder.mkdir()

    def tearDown(self):
        self.here.cleanup()

    def write(self, sectors):
        (self.folder / "design.csv").write_text("test,effect\na,none\nb,cohesion\n")
        rows = "".join(f"{t},fit,mixer,torque_ripple,0.4,0.1,1,0.5,0.1,\n" for t in "ab")
        (self.folder / "observations.csv").write_text(OBSERVATIONS + rows)
        (self.folder / "sources.csv").write_text(
            "test,kind,source,torque_Nm\n"
            + "".join(f"{t},phase,{s},{x}\n" for t in "ab" for s, x in zip(SECTORS, sectors))
            + "a,part,shaft,7\n"
        )

    # the sectors that have observables, as the programs know them (begin: 60 k - 180)
    def test_sectors_are_those_of_the_programs(self):
        header = (ROOT / "postproc/core/paddle_sectors.h").read_text()
        begins = {name: 60 * int(k) - 180 for name, k in re.findall(r'"paddle_share_(\w+)", (\d)', header)}
        self.assertEqual(shares_module.SECTORS, {n: f"{a} to {a + 60} deg" for n, a in begins.items()})
        self.assertEqual(len(begins), 3)

    # 1, 2, 3, 4, 5, 6 sum to 21: the sectors from -120, -60 and 60 hold 2, 3 and 5
    def test_sectors_of_the_baseline_over_their_sum(self):
        self.write([1, 2, 3, 4, 5, 6])
        out = self.folder / "out.csv"
        done = shares(self.folder, "--wall", "steel", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out) as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([r["test"] for r in rows], ["law_a"] * 3)
        for row, name, torque in zip(rows, ("carried", "entering", "leaving"), (2, 3, 5)):
            self.assertEqual(row["observable"], f"paddle_share_{name}")
            self.assertAlmostEqual(float(row["value"]), torque / 21, delta=1e-6)
            self.assertEqual((row["wall"], row["speed"], row["unit"]), ("steel", "0.5", "1"))

    def test_refuses_runs_without_sectors_and_sectors_that_are_no_numbers(self):
        self.write([1, 2, "x", 4, 5, 6])
        done = shares(self.folder, "--out", self.folder / "out.csv")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("sources.csv:4: torque_Nm is 'x'", done.stderr)
        (self.folder / "sources.csv").write_text("test,kind,source,torque_Nm\na,part,shaft,7\n")
        done = shares(self.folder, "--out", self.folder / "out.csv")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("holds no paddle's torque by sector", done.stderr)
        self.assertFalse((self.folder / "out.csv").exists())

    def test_the_committed_table_is_made_by_it(self):
        out = self.folder / "out.csv"
        done = shares(ROOT / "findings/withheld_mixer/truth_hooke", "--wall", "steel", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(out.read_text(), (ROOT / "libraries/laws/mixer_hooke_paddle.csv").read_text())


unittest.main()
