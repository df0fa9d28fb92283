# SPDX-License-Identifier: GPL-2.0-or-later
"""The command scripts/mutate."""
import argparse
import os
import pathlib
import shlex
import shutil
import subprocess
import time

from tools import ROOT, command_line, mutate, tables
from tools.errors import BadInput, RunFailed

HERE = pathlib.Path(__file__).resolve().parent
LAW = ["law_formulas_test", "law_half_period_test", "law_rotation_test"]
# source: the test programs that hold it, of tests/
TESTS = {
    "liggghts_addons/law/vielto_law.h": [f"law/{t}" for t in LAW],
    "liggghts_addons/law/cohfrict_law.h": ["law/cohfrict_law_test"],
    "liggghts_addons/law/stock_springs.h": ["law/stock_springs_test"],
    "liggghts_addons/law/walton_braun_law.h": ["law/walton_braun_law_test"],
    "gap/verdict/threshold.cpp": ["gap/gap_evidence_test"],
    "gap/verdict/evidence.cpp": ["gap/gap_likelihood_test"],
    "gap/verdict/diagnosis.cpp": ["gap/gap_judgement_test"],
    "gap/question/repeats.cpp": ["gap/gap_repeats_test"],
    "gap/question/inputs.cpp": ["gap/gap_question_test"],
}
NO_FLIP = -1
EQUIVALENT = HERE / "equivalent.csv"  # source,text,change,nth (of those alike),why


def main():
    return command_line.run("mutate", mutate.__doc__, add_options, work)


def add_options(parser):
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("sources", nargs="*", metavar="SOURCE", help=f"without one all: {', '.join(TESTS)}")
    parser.add_argument("--list", action="store_true", help="only list the flips")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="each N-th flip only")
    parser.add_argument(
        "--build", type=pathlib.Path, default=ROOT / "build", help="where the libraries are built (default: build)"
    )
    parser.add_argument("--filter", default="*", help="only these tests (--gtest_filter)")


def work(options):
    for source in options.sources:
        if source not in TESTS:
            raise BadInput(f"{source}: no tests are named for it; take one of {', '.join(TESTS)}")
    subprocess.run([ROOT / "scripts/install-packages", "test", "mutate"], check=True)
    table = tables.read(EQUIVALENT, ["source", "text", "change", "nth"], "bring it back")
    equivalent = {(r["source"], r["text"], r["change"], int(r["nth"])) for r in table}
    left = 0
    for source in options.sources or TESTS:
        left += mutate_source(source, options, {tuple(key) for of, *key in equivalent if of == source})
    return 1 if left else 0


def mutate_source(source, options, equivalent):
    """How many flips nobody sees."""
    from tools.mutate.source import Mutated

    path = ROOT / source
    mutated = Mutated(path, ["-x", "c++", "-std=c++17", *flags(path)])
    flips = mutated.flips[:: options.every]
    if options.list:
        for f in mutated.flips:
            print(f"{source}:{f.line}: {f.change}: {f.text}")
        return 0
    folder = options.build / "mutants" / pathlib.Path(source).name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    programs = [build(test, path, mutated.text, folder, options.build) for test in TESTS[source]]
    took = [run(program, 0, 600, options.filter) for program in programs]
    for program, seconds in zip(programs, took):
        if seconds is None:
            raise RunFailed(f"{program}: fails without a flip")
    survivors, same, none = [], 0, 0
    for flip in flips:
        told = (run(program, flip.number, 10 * t + 5, options.filter) for program, t in zip(programs, took))
        result = next((t for t in told if t is None or t == NO_FLIP), "survives")
        if result is None:
            continue
        if result == NO_FLIP:
            none += 1
        elif (flip.text, flip.change, flip.nth) in equivalent:
            same += 1
        else:
            survivors.append(flip)
            print(f"{source}:{flip.line}: {flip.change}: {flip.text}", flush=True)
    tried = len(flips) - same - none
    of = f" (each {options.every}th of {len(mutated.flips)})" if options.every > 1 else ""
    print(f"{source}: {tried - len(survivors)} of {tried} flips caught{of}, {same} equivalent", flush=True)
    return len(survivors)


def flags(path):
    law = ROOT / "liggghts_addons"
    packages = subprocess.run(
        ["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True, check=True
    ).stdout.split()
    return [f"-I{ROOT}", f"-I{path.parent}", f"-I{law}", f"-I{law / 'law'}", f"-I{ROOT / 'postproc'}", *packages]


def build(test, path, text, folder, libraries):
    """The test program with the mutated source in it. A header's copy stands before it in the search, a .cpp before its library."""
    program = folder / pathlib.Path(test).name
    copy = folder / path.name
    copy.write_bytes(text)
    sources = [ROOT / "tests" / f"{test}.cpp"] + ([copy] if path.suffix == ".cpp" else [])
    command = ["c++", "-std=c++17", "-O1", "-w", f"-I{folder}", *flags(path), f'-DVIELTO_SOURCE_DIR="{ROOT}"']
    command += [f'-DVIELTO_BIN_DIR="{libraries / "bin"}"', *sources, "-o", program]
    if path.suffix == ".cpp":
        archives = ["gap/libvielto_gap.a", "postproc/libvielto_post.a", "postproc/libvielto_core.a"]
        command += [libraries / a for a in archives]
    command += ["-lgtest_main", "-lgtest", "-lfmt", "-lcrypto", "-ltomlplusplus", "-lpthread"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode:
        raise RunFailed(f"{shlex.join(map(str, command))}\n{result.stderr[:3000]}")
    return program


def run(program, number, seconds, only):
    """Seconds taken; None if a test failed, NO_FLIP if there is none of that number."""
    began = time.monotonic()
    try:
        status = subprocess.run(
            [program, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={only}"],
            env=dict(os.environ, MUTANT=str(number)),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=seconds,
        ).returncode
    except subprocess.TimeoutExpired:
        return None
    return time.monotonic() - began if status == 0 else NO_FLIP if status == 99 else None
