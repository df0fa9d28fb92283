#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/library add: a library in portions is the library made in one go; a changed file needs repeated runs with equal numbers.

  library_add_test.py VIELTO      the program; run from anywhere
The campaign's results are stand-ins: what a run leaves, with numbers from a formula.
"""
import csv
import hashlib
import json
import pathlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLAN = """seeds = 6
[[rig]]
name = "drum"
conditions = [{tilt = 0}, {tilt = 45}]
[[rig.effect]]
name = "wall_friction"
strengths = [7, 14]
at = [1, 2]
"""
HEADER = (
    "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material"
)


class Portion(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        gap = self.folder / "libraries"
        (gap / "millet").mkdir(parents=True)
        shutil.copytree(ROOT / "libraries/effects", gap / "effects")
        shutil.copy(ROOT / "libraries/diagnosis.toml", gap)
        for name in ("cases", "materials", "liggghts_addons"):  # the runs' inputs, which the test changes
            shutil.copytree(ROOT / name, self.folder / name, ignore=shutil.ignore_patterns("results"))
        (gap / "millet/plan.toml").write_text(PLAN)
        self.assertEqual(self.vielto("gap", "plan", "libraries/millet/plan.toml", "--out", "study.csv").returncode, 0)
        with open(self.folder / "study.csv") as file:
            self.runs = list(csv.DictReader(file))
        self.assertEqual(len(self.runs), 6 * 2 + 2 * 2)

    def tearDown(self):
        shutil.rmtree(self.folder)

    def run_program(self, *words):
        env = dict(os.environ, PATH=f"{VIELTO.parent}:{os.environ['PATH']}")
        return subprocess.run(list(map(str, words)), cwd=self.folder, env=env, capture_output=True, text=True)

    def vielto(self, *words):
        return self.run_program(VIELTO, *words)

    def portion(self, results):
        return self.run_program(
            ROOT / "scripts/library", "add", "libraries/millet/plan.toml", results, "libraries/millet"
        )

    def finish(self, results, runs, shift=0.0):
        script = hashlib.sha256((self.folder / "cases/drum/in.drum").read_bytes()).hexdigest()
        for k, run in enumerate(runs):
            folder = self.folder / results
            (folder / "runs" / run["run"]).mkdir(parents=True, exist_ok=True)
            (folder / "post").mkdir(exist_ok=True)
            (folder / "runs" / run["run"] / "run.json").write_text(
                json.dumps({"hashes": {"in.drum": script}, "parameters": dict(run)})
            )
            value = 36 + float(run["tilt"]) / 6 + 0.1 * int(run["seed"]) + shift
            (folder / "post" / f"{run['run']}.csv").write_text(
                f"{HEADER}\n{run['run']},fit,drum,angle,{value},0.5,deg,0.083333,0.5,,,,{run['tilt']},wall_A,wheat\n"
            )

    def library(self):
        """file -> its rows, in any order"""
        return {p.name: sorted(p.read_text().splitlines()) for p in (self.folder / "libraries/millet").glob("*.csv")}

    def collect(self, results):
        done = self.vielto("gap", "collect", "libraries/millet/plan.toml", results, "--out", "libraries/millet")
        self.assertEqual(done.returncode, 0, done.stderr)

    def change_script(self):
        with open(self.folder / "cases/drum/in.drum", "a") as file:
            file.write("# a remark\n")

    def test_two_portions_are_one_library(self):
        self.finish("all", self.runs)
        self.collect("all")
        whole = self.library()
        self.assertNotIn("sources.csv", whole)  # the parts of a mixer; a drum has none
        for path in (self.folder / "libraries/millet").glob("*.csv"):
            path.unlink()
        self.finish("first", self.runs[:12]), self.finish("second", self.runs[12:])
        self.collect("first")
        done = self.portion("second")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("4 runs added, 16 of 16", done.stdout)
        self.assertEqual(self.library(), whole)

    def test_what_the_plan_has_no_longer_goes(self):
        self.finish("first", self.runs)
        self.collect("first")
        (self.folder / "libraries/millet/plan.toml").write_text(PLAN.replace("[7, 14]", "[7, 20]"))
        done = self.vielto("gap", "plan", "libraries/millet/plan.toml", "--out", "study.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "study.csv") as file:
            self.finish("second", [run for run in csv.DictReader(file) if "friction20" in run["run"]])
        self.assertEqual(self.portion("second").returncode, 0)
        text = "\n".join(self.library()["design.csv"])
        self.assertIn("drum1_wall_friction20_s301", text)
        self.assertNotIn("wall_friction14", text)
        self.assertIn("wall_friction7", text)

    def test_runs_of_an_effect_that_was_another_are_taken_out(self):
        self.finish("first", self.runs)
        self.collect("first")
        self.assertIn("wall_friction,drum,wall_frictionAngle offset 2", self.library()["effects.csv"])
        effect = self.folder / "libraries/effects/wall_friction.toml"
        effect.write_text(effect.read_text().replace("factor = 2.0", "factor = 3.0"))
        # the old runs are not taken for runs of the new effect ...
        done = self.vielto("gap", "collect", "libraries/millet/plan.toml", "first", "--out", "other")
        self.assertEqual(done.returncode, 2)
        self.assertIn("made with wall_frictionAngle", done.stderr)
        # ... a new run takes the place of all of them
        self.assertEqual(self.vielto("gap", "plan", "libraries/millet/plan.toml", "--out", "study.csv").returncode, 0)
        with open(self.folder / "study.csv") as file:
            self.finish("new", [run for run in csv.DictReader(file) if "wall_friction7" in run["run"]], shift=0.1)
        done = self.portion("new")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 runs added, 14 of 16", done.stdout)
        self.assertIn("4 of wall_friction taken out", done.stdout)
        self.assertIn("wall_friction,drum,wall_frictionAngle offset 3", self.library()["effects.csv"])
        self.assertNotIn(
            "wall_friction14", "\n".join(self.library()["design.csv"] + self.library()["observations.csv"])
        )

    def test_a_changed_file_needs_runs_that_show_that_it_makes_no_difference(self):
        self.finish("first", self.runs[:12])
        self.collect("first")
        before = self.library()
        self.change_script()
        self.finish("new", self.runs[12:])
        done = self.portion("new")
        self.assertEqual(done.returncode, 2)
        self.assertIn("in.drum", done.stderr)
        self.assertIn("repeat 2 of its runs", done.stderr)
        self.assertEqual(self.library(), before)
        self.finish("new", self.runs[3:5])
        done = self.portion("new")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("made no difference", done.stdout)
        script = hashlib.sha256((self.folder / "cases/drum/in.drum").read_bytes()).hexdigest()
        self.assertIn(script, "\n".join(self.library()["inputs.csv"]))
        self.assertEqual(len(self.library()["observations.csv"]), 1 + 16)

    def test_other_numbers_are_refused(self):
        self.finish("first", self.runs[:12])
        self.collect("first")
        before = self.library()
        self.change_script()
        self.finish("new", self.runs[3:5], shift=1e-6)
        done = self.portion("new")
        self.assertEqual(done.returncode, 2)
        self.assertIn("has other numbers", done.stderr)
        self.assertEqual(self.library(), before)
        self.assertEqual(
            [p.name for p in (self.folder / "libraries").iterdir() if p.is_dir() and p.name.startswith("tmp")], []
        )


if __name__ == "__main__":
    VIELTO = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
