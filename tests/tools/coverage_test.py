# SPDX-License-Identifier: GPL-2.0-or-later
"""A tracefile's counts by folder: ours only, headers in their room, tests and the system's left out."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools import coverage  # noqa: E402
from tools.errors import BadInput  # noqa: E402


def record(source, functions, called, lines, run):
    return f"SF:{source}\nFNF:{functions}\nFNH:{called}\nDA:1,5\nLF:{lines}\nLH:{run}\nend_of_record\n"


class Coverage(unittest.TestCase):
    def count(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "coverage.info"
            path.write_text(text)
            return coverage.count(path)

    def test_counts_by_folder(self):
        text = "TN:\n" + record(ROOT / "postproc/core/csv.cpp", 4, 3, 100, 90)
        text += record(ROOT / "postproc/core/csv.h", 1, 1, 10, 10) + record(ROOT / "vielto/main.cpp", 2, 1, 50, 0)
        text += record(ROOT / "tests/core/csv_test.cpp", 9, 9, 900, 900) + record(
            "/usr/include/fmt/core.h", 9, 0, 99, 0
        )
        self.assertEqual(self.count(text), {"postproc/core": [110, 100, 5, 4], "vielto": [50, 0, 2, 1]})
        self.assertEqual(coverage.row("vielto", [50, 5, 2, 1]).split(), "vielto 50 5 10.0 2 1 50.0".split())

    def test_nothing_was_run(self):
        with self.assertRaises(BadInput):
            self.count("TN:\n" + record("/usr/include/fmt/core.h", 9, 0, 99, 0))


if __name__ == "__main__":
    unittest.main()
