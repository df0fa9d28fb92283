# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/blind list-strong: strong cases of one known effect whose answer is a gap."""
import json
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts/blind"


class ListStrong(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        (self.root / "truth").mkdir()

    def tearDown(self):
        self.folder.cleanup()

    def case(self, name, verdict, kind="known", level="strong"):
        (self.root / "truth" / f"{name}.json").write_text(json.dumps({"case": name, "kind": kind, "level": level}))
        if verdict:
            (self.root / "answers" / name).mkdir(parents=True)
            # a variant of the settings says something else than the answer
            other = "named" if verdict == "no_gap" else "no_gap"
            (self.root / "answers" / name / "diagnosis.json").write_text(
                json.dumps({"verdict": verdict, "sensitivity": [{"verdict": other}]}, indent=1)
            )

    def run_it(self):
        return subprocess.run(
            [PROGRAM, "list-strong", self.root / "truth", self.root / "answers"], capture_output=True, text=True
        )

    def test_goes_by_the_answers_verdict_alone(self):
        self.case("1", "named")
        self.case("2", "no_gap")
        self.case("3", "ambiguous")
        self.case("4", "unknown")
        self.case("5", "named", level="middle")
        self.case("6", "named", kind="removed")
        done = self.run_it()
        self.assertEqual((done.returncode, done.stdout), (0, "1 3 4\n"), done.stderr)

    def test_a_case_without_an_answer_is_one_clear_line(self):
        self.case("1", None)
        done = self.run_it()
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"^blind list-strong: .*1/diagnosis.json: .*diagnose the cases first.*\n$")


unittest.main()
