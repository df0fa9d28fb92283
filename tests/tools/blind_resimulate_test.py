# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/blind resimulate: which cases are drawn, and what `vielto gap confirm` is asked."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts/blind"
# says what it was asked, and fails for a case named bad; with MADE it plans a run that all cases ask for and one of the case
# alone, and lists in MADE which of them it had to make
VIELTO = """#!/usr/bin/python3
import json, os, pathlib, sys
asked = sys.argv[1:]
open(os.environ["ASKED"], "a").write(" ".join(asked) + "\\n")
if "/bad/" in asked[2]:
    sys.exit(1)
runs = pathlib.Path(asked[asked.index("--out") + 1]) / "runs"
case = pathlib.Path(asked[2]).parent.name
for name, value in [("all", 1), (case, 2)] if "MADE" in os.environ else []:
    run = runs / name
    command = f"liggghts -in in.mixer -var speed {name} -var run {run}"
    if "--run" not in asked:
        print(f"(cd cases/mixer && {command} && vielto post {run})")
    elif not (run / "post/observations.csv").exists():
        (run / "post").mkdir(parents=True)
        (run / "run.json").write_text(json.dumps({"command": command, "hashes": {"in.mixer": os.environ["HASH"]}}))
        rows = f"m,mixer,power,{value}\\nm,mixer,torque_ripple,9\\n"
        (run / "post/observations.csv").write_text("test,apparatus,observable,value\\n" + rows)
        open(os.environ["MADE"], "a").write(name + "\\n")
"""


class Resimulate(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        (self.root / "truth").mkdir()
        (self.root / "bin").mkdir()
        program = self.root / "bin/vielto"
        program.write_text(VIELTO)
        program.chmod(0o755)

    def tearDown(self):
        self.folder.cleanup()

    def case(self, name, verdict="named"):
        (self.root / "truth" / f"{name}.json").write_text(
            json.dumps({"case": name, "kind": "known", "level": "strong"})
        )
        (self.root / "answers" / name).mkdir(parents=True)
        (self.root / "answers" / name / "diagnosis.json").write_text(json.dumps({"verdict": verdict}))

    def run_it(self, *how, options=(), **more):
        asked = self.root / "asked"
        asked.write_text("")
        env = dict(os.environ, PATH=f"{self.root}/bin:{os.environ['PATH']}", ASKED=str(asked), **more)
        words = [
            PROGRAM,
            "resimulate",
            *how,
            *(self.root / n for n in ("truth", "answers", "cases")),
            "s.json",
            "millet",
        ]
        done = subprocess.run([*words, *options], capture_output=True, text=True, env=env)
        return done, asked.read_text().splitlines()

    def names(self, asked):
        return [pathlib.Path(line.split()[2]).parent.name for line in asked]

    def test_draws_a_share_of_the_cases_that_have_something_to_simulate(self):
        for k in range(8):
            self.case(f"c{k}")
        self.case("flat", "no_gap")
        done, half = self.run_it("--share", "0.5", "--draw", "3", options=("--reference", "dry.csv"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(half), 4)
        self.assertIn("simulated again: " + " ".join(self.names(half)) + "\n", done.stdout)
        for line in half:
            self.assertTrue(line.startswith("gap confirm "), line)
            self.assertTrue(line.endswith("--reference dry.csv --run"), line)
        _, every = self.run_it("--share", "1", "--draw", "3")
        self.assertEqual(sorted(self.names(every)), [f"c{k}" for k in range(8)])
        self.assertEqual(self.names(every)[:4], self.names(half))
        _, other = self.run_it("--share", "1", "--draw", "4")
        self.assertNotEqual(self.names(other), self.names(every))

    def made(self, kept, hash_="1"):
        """The runs that a call had to make."""
        made = self.root / "made"
        made.write_text("")
        done, _ = self.run_it("--share", "1", "--kept", str(kept), MADE=str(made), HASH=hash_)
        return done, made.read_text().split()

    def test_a_run_that_is_kept_is_made_for_no_case_again(self):
        for k in range(3):
            self.case(f"c{k}")
            (self.root / f"cases/c{k}").mkdir(parents=True)
            (self.root / f"cases/c{k}/observations.csv").write_text("role,observable\nfit,speed\ncheck,power\n")
        kept = self.root / "kept.csv"
        done, made = self.made(kept)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(made), ["all", "c0", "c1", "c2"])
        lines = kept.read_text().splitlines()
        self.assertEqual(lines[:2], ["run,test,apparatus,observable,value", "file,in.mixer,,1,"])
        self.assertEqual(
            sorted(line.split(",", 1)[1] for line in lines[2:]), ["m,mixer,power,1"] + 3 * ["m,mixer,power,2"]
        )
        whole = kept.read_text()
        for k in range(3):  # another session, its folder empty
            shutil.rmtree(self.root / f"answers/c{k}/runs")
        kept.write_text("\n".join(lines[:-1]) + "\n")
        _, made = self.made(kept)
        self.assertEqual(len(made), 1)
        self.assertEqual(sorted(kept.read_text().splitlines()), sorted(whole.splitlines()))
        for path in self.root.glob("answers/c*/runs/*/run.json"):
            self.assertEqual(json.loads(path.read_text())["hashes"], {"in.mixer": "1"})

    def test_what_was_made_from_other_files_is_one_clear_line(self):
        self.case("c0")
        (self.root / "cases/c0").mkdir(parents=True)
        (self.root / "cases/c0/observations.csv").write_text("role,observable\ncheck,power\n")
        kept = self.root / "kept.csv"
        kept.write_text("run,test,apparatus,observable,value\nfile,in.mixer,,1,\n0,m,mixer,power,1\n")
        done, _ = self.made(kept, hash_="2")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^blind resimulate: [^\n]*kept.csv: was made from other files than [^\n]*\n$")

    def test_a_share_over_one_and_a_failure_are_one_clear_line(self):
        self.case("bad")
        for how, text in ((("--share", "1.5"), "out of range"), ((), "could not be simulated again")):
            done, _ = self.run_it(*how)
            self.assertNotEqual(done.returncode, 0)
            self.assertRegex(done.stderr, rf"^blind resimulate: [^\n]*{text}[^\n]*\n$")


unittest.main()
