# SPDX-License-Identifier: GPL-2.0-or-later
"""Share of our own code that tests run (gcov, lcov): a table of lines and functions by folder.

Builds the preset `coverage`, runs the tests of the labels given, and counts. Without a label it runs what `scripts/test --fast`
runs. Headers count where they are compiled in, tests themselves not."""
import argparse
import collections
import pathlib
import subprocess

from tools import ROOT, command_line
from tools.errors import BadInput

FOLDER = ROOT / "build-coverage"
OWN = ("gap", "liggghts_addons", "postproc", "report", "vielto")


def add_options(parser):
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("labels", nargs="*", metavar="LABEL", help="labels of tests, such as core law gap cli")
    parser.add_argument("--target", nargs="+", default=[], metavar="TARGET", help="build these only")
    parser.add_argument("--no-run", action="store_true", help="count what has been run")


def work(options):
    subprocess.run([ROOT / "scripts/install-packages", "test", "coverage"], check=True)
    failed = 0
    if not options.no_run:
        subprocess.run([ROOT / "scripts/build", "coverage", *options.target], check=True)
        for old in FOLDER.rglob("*.gcda"):
            old.unlink()
        chosen = ["-L", f"^({'|'.join(options.labels)})$"] if options.labels else ["-LE", "slow$"]
        failed = subprocess.run(
            ["xvfb-run", "-a", "ctest", *chosen, "-j2", "--output-on-failure"], cwd=FOLDER
        ).returncode
    counts = count(tracefile())
    print(f"{'folder':<32}{'lines':>8}{'run':>8}{'%':>7}{'functions':>12}{'run':>8}{'%':>7}")
    for folder in sorted(counts):
        print(row(folder, counts[folder]))
    print(row("all", [sum(c[k] for c in counts.values()) for k in range(4)]))
    return failed


def tracefile():
    """What lcov gathers from all programs' counts."""
    path = FOLDER / "coverage.info"
    # it warns of itself, of two hundred subroutines
    command = ["lcov", "--quiet", "--capture", "--directory", FOLDER, "--base-directory", ROOT, "--no-external"]
    subprocess.run([*command, "--output-file", path], check=True, stderr=subprocess.DEVNULL)
    return path


def count(path):
    """{folder: [lines, lines run, functions, functions run]} of our own files in a tracefile. A header has a record of each
    program that it was compiled into, a template a function of each of its types: run is what ran in one of them."""
    lines, functions = collections.defaultdict(bool), collections.defaultdict(bool)
    source, begins = None, {}
    for text in path.read_text().splitlines():
        key, _, value = text.partition(":")
        first, _, second = value.partition(",")
        if key == "SF":
            source, begins = value, {}
        elif key == "DA":
            lines[source, int(first)] |= int(second.split(",")[0]) > 0
        elif key == "FN":
            begins[second] = int(first)
        elif key == "FNDA":
            functions[source, begins[second]] |= int(first) > 0
    counts = collections.defaultdict(lambda: [0, 0, 0, 0])
    for at, runs in ((0, lines), (2, functions)):
        for (name, _), run in runs.items():
            folder = folder_of(pathlib.Path(name))
            if folder:
                counts[folder][at] += 1
                counts[folder][at + 1] += run
    if not counts:
        raise BadInput(f"{path}: holds no file of ours; run tests first")
    return dict(counts)


def folder_of(source):
    """The room of a source, None where it is not ours."""
    try:
        parts = source.relative_to(ROOT).parts
    except ValueError:
        return None
    return "/".join(parts[:2] if len(parts) > 2 else parts[:1]) if parts[0] in OWN else None


def row(name, counts):
    lines, hit, functions, called = counts
    shares = [100 * part / whole if whole else 100 for part, whole in ((hit, lines), (called, functions))]
    return f"{name:<32}{lines:>8}{hit:>8}{shares[0]:>7.1f}{functions:>12}{called:>8}{shares[1]:>7.1f}"


def main():
    return command_line.run("coverage", __doc__, add_options, work)
