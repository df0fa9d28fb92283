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


def record(source, lines, functions):
    """lines {number: times}, functions {(line, name): times}."""
    text = f"SF:{source}\n" + "".join(f"FN:{line},{name}\n" for line, name in functions)
    text += "".join(f"FNDA:{times},{name}\n" for (_, name), times in functions.items())
    return text + "".join(f"DA:{number},{times}\n" for number, times in lines.items()) + "end_of_record\n"


class Coverage(unittest.TestCase):
    def count(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "coverage.info"
            path.write_text(text)
            return coverage.count(path)

    def test_counts_by_folder(self):
        # a header of two programs, each of which runs one of its lines and one of its template's types
        header = ROOT / "postproc/core/csv.h"
        text = "TN:\n" + record(header, {1: 5, 2: 0, 3: 0}, {(1, "f<int>"): 5, (1, "f<double>"): 0, (3, "g"): 0})
        text += record(header, {1: 0, 2: 7, 3: 0}, {(1, "f<char>"): 0})
        text += record(ROOT / "postproc/core/csv.cpp", {1: 1}, {(1, "h"): 1}) + record(
            ROOT / "vielto/main.cpp", {9: 0}, {}
        )
        text += record(ROOT / "tests/core/csv_test.cpp", {1: 1}, {(1, "t"): 1})
        text += record("/usr/include/fmt/core.h", {1: 1}, {})
        self.assertEqual(self.count(text), {"postproc/core": [4, 3, 3, 2], "vielto": [1, 0, 0, 0]})
        self.assertEqual(coverage.row("vielto", [50, 5, 2, 1]).split(), "vielto 50 5 10.0 2 1 50.0".split())

    def test_nothing_was_run(self):
        with self.assertRaises(BadInput):
            self.count("TN:\n" + record("/usr/include/fmt/core.h", {1: 0}, {}))


if __name__ == "__main__":
    unittest.main()
