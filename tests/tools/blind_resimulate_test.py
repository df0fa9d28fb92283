# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/blind resimulate: which cases are drawn, and what `vielto gap confirm` is asked."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts/blind"
# says what it was asked, and fails for a case named bad
VIELTO = '#!/bin/sh\necho "$@" >> "$ASKED"\ncase "$3" in */bad/*) exit 1;; esac\n'


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

    def run_it(self, *how, options=()):
        asked = self.root / "asked"
        asked.write_text("")
        env = dict(os.environ, PATH=f"{self.root}/bin:{os.environ['PATH']}", ASKED=str(asked))
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
            self.assertTrue(line.endswith("--run --reference dry.csv"), line)
        _, every = self.run_it("--share", "1", "--draw", "3")
        self.assertEqual(sorted(self.names(every)), [f"c{k}" for k in range(8)])
        self.assertEqual(self.names(every)[:4], self.names(half))
        _, other = self.run_it("--share", "1", "--draw", "4")
        self.assertNotEqual(self.names(other), self.names(every))

    def test_a_share_over_one_and_a_failure_are_one_clear_line(self):
        self.case("bad")
        for how, text in ((("--share", "1.5"), "out of range"), ((), "could not be simulated again")):
            done, _ = self.run_it(*how)
            self.assertNotEqual(done.returncode, 0)
            self.assertRegex(done.stderr, rf"^blind resimulate: [^\n]*{text}[^\n]*\n$")


unittest.main()
