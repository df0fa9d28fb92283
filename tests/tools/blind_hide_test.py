# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/blind hide: what is hidden is out of reach while the command runs, and comes back however it ends."""
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts/blind"


class Hide(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        (self.root / "truth").mkdir()
        (self.root / "truth" / "1.json").write_text("a")
        (self.root / "seals").write_text("b")

    def tearDown(self):
        self.folder.cleanup()

    def run_it(self, *words):
        return subprocess.run([PROGRAM, "hide", *words], cwd=self.root, capture_output=True, text=True)

    def is_back(self):
        return (self.root / "truth" / "1.json").read_text() + (self.root / "seals").read_text() == "ab"

    def test_hides_while_the_command_runs_and_passes_its_status_on(self):
        done = self.run_it("truth", "seals", "--", "bash", "-c", "ls; exit 7")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (7, "", ""))
        self.assertTrue(self.is_back())

    def test_comes_back_when_told_to_end(self):
        done = self.run_it("truth", "seals", "--", "bash", "-c", "kill $PPID; sleep 0.2; ls >seen; sleep 20; ls >late")
        self.assertNotEqual(done.returncode, 0)
        self.assertTrue(self.is_back())
        # the command has ended before anything came back, so that it can have seen nothing
        self.assertNotIn("truth", (self.root / "seen").read_text() if (self.root / "seen").exists() else "")
        self.assertFalse((self.root / "late").exists())

    def test_refuses_what_is_not_there_and_moves_nothing(self):
        done = self.run_it("truth", "nothing", "--", "true")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^blind hide: there is no nothing to hide; .*\n$")
        self.assertTrue(self.is_back())

    def test_without_a_command_it_tells_its_use(self):
        for words in ((), ("truth",), ("truth", "--"), ("--", "true")):
            done = self.run_it(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertRegex(done.stderr, r"^blind hide: .*; usage: blind hide PATH\.\.\. -- COMMAND\.\.\.\n$")
            self.assertTrue(self.is_back())


unittest.main()
