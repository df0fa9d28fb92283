# SPDX-License-Identifier: GPL-2.0-or-later
"""Coverage-guided fuzzing of every reader (libFuzzer, address and undefined-behaviour sanitizers): a table of executions.

Each reader of tests/fuzz gets the repository's own files as seeds and runs until its number of executions is reached. A crash, an
exception other than a refusal, over 2 s or 1 GB is a fault: its input stays in the folder, and the exit status is 1."""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import time

from tools import command_line
from tools.errors import BadInput

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / "build-fuzz"
MOST_SEED = 1200  # bytes: long files are cut, for short inputs are tried more often

# reader: share of all executions, seeds
READERS = {
    "observation_table": (3, ["cases/*/results/*.observations.csv", "findings/*/*.observations.csv"]),
    "reduced_table": (1, ["cases/*/results/*.observations.csv"]),
    "covariance": (2, ["tests/fuzz/seeds/covariance.csv"]),
    "torque_record": (3, ["tests/fuzz/seeds/torque.csv"]),
    "shear_record": (2, ["tests/fuzz/seeds/shear.csv"]),
    "heap_record": (2, ["tests/fuzz/seeds/heap.csv"]),
    "bed_record": (2, ["tests/fuzz/seeds/bed_1.csv"]),
    "silo_record": (2, ["tests/fuzz/seeds/silo.csv"]),
    "par_file": (3, ["cases/*/*.par", "cases/*.par", "materials/*.par"]),
    "card": (2, ["materials/*.par"]),
    "mixer_file": (1, ["cases/mixer/mixer.par"]),
    "effect": (3, ["libraries/effects/*.toml"]),
    "plan": (0.3, ["libraries/*/plan.toml", "tests/data/toy_plan.toml"]),
    "rig_table": (2, ["cases/rigs.toml"]),
    "settings": (2, ["libraries/diagnosis.toml"]),
    "next_tests": (2, ["libraries/next_tests.toml"]),
    "stl": (2, ["tests/fuzz/seeds/*.stl"]),
    "yade_text": (3, ["tests/fuzz/seeds/plot*.txt", "tests/data/yade/grains.txt"]),
    "vtk_spheres": (0.05, ["tests/data/yade/*.vtu"]),
    "logger": (3, ["tests/fuzz/seeds/logger*.csv"]),
    "surface": (2, ["tests/fuzz/seeds/surface.csv"]),
    "any_json": (2, ["findings/*/diagnosis.json", "cases/mixer/results/*.json"]),
    "diagnosis_json": (1, ["findings/*/diagnosis.json", "findings/*/*/diagnosis.json"]),
    "sealed_json": (1, ["findings/*/sealed/isolability.json"]),
    "equation_json": (2, ["cases/mixer/results/*.equation.json"]),
    "power_json": (2, ["tests/fuzz/seeds/power.json"]),
    "run_json": (2, ["tests/fuzz/seeds/run.json"]),
    "library_design": (1, ["tests/fuzz/seeds/design.csv"]),
    "discrepancy": (2, ["libraries/*/discrepancy.csv"]),
    "data_file": (2, ["tests/fuzz/seeds/shear.csv", "cases/*/results/*.runs.csv"]),
    "clump": (1, ["tests/fuzz/seeds/clump.txt", "materials/*.txt", "materials/*.clump"]),
}
# long because the file is one whole: cut it and nothing is left
WHOLE = {
    "plan",
    "rig_table",
    "settings",
    "any_json",
    "diagnosis_json",
    "sealed_json",
    "equation_json",
    "vtk_spheres",
    "next_tests",
}


def add_options(parser):
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("readers", nargs="*", metavar="READER", help=f"without one all: {', '.join(READERS)}")
    parser.add_argument("--executions", type=float, default=1e5, help="of all readers together (default: 1e5)")
    parser.add_argument("--no-build", action="store_true", help="take the programs as they are")


def work(options):
    for reader in options.readers:
        if reader not in READERS:
            raise BadInput(f"{reader}: no such reader; take {', '.join(READERS)}")
    readers = options.readers or list(READERS)
    if not options.no_build:
        subprocess.run([ROOT / "scripts/install-packages", "demo", "fuzz"], check=True)
        subprocess.run([ROOT / "scripts/build", "fuzz", *(f"fuzz_{r}" for r in readers)], check=True)
    whole = sum(share for share, _ in READERS.values())
    total = faults = 0
    print(f"{'reader':<20}{'executions':>12}{'edges':>8}{'inputs':>8}{'kB':>8}{'s':>8}{'faults':>8}")
    for reader in readers:
        executions = max(1000, round(options.executions * READERS[reader][0] / whole))
        start = time.monotonic()
        done, edges, bad = fuzz(reader, executions)
        sizes = [p.stat().st_size for p in (FOLDER / "corpus" / reader).iterdir()]
        total += done
        faults += len(bad)
        took = time.monotonic() - start
        counts = f"{done:>12}{edges:>8}{len(sizes):>8}{sum(sizes) / 1000:>8.0f}{took:>8.0f}{len(bad):>8}"
        print(f"{reader:<20}{counts}", *bad, flush=True)
    print(f"{'all':<20}{total:>12}{'':>32}{faults:>8}")
    return 1 if faults else 0


def fuzz(reader, executions):
    """Executions done, edges of the program reached, inputs that are faults."""
    corpus = FOLDER / "corpus" / reader
    corpus.mkdir(parents=True, exist_ok=True)
    faults = FOLDER / "faults" / reader
    faults.mkdir(parents=True, exist_ok=True)
    for number, path in enumerate(seeds(reader)):
        (corpus / f"seed_{number}").write_bytes(shortened(path, reader))
    most = max(p.stat().st_size for p in corpus.iterdir())
    options = [f"-runs={executions}", "-timeout=2", "-rss_limit_mb=1024", f"-max_len={most + 200}", "-detect_leaks=0"]
    log = libfuzzer(reader, [*options, "-print_final_stats=1", f"-artifact_prefix={faults}/", corpus])
    (FOLDER / "faults" / f"{reader}.log").write_text(log.stderr)
    done = re.search(r"stat::number_of_executed_units: *(\d+)", log.stderr)
    edges = re.findall(r" cov: (\d+) ", log.stderr)
    bad = sorted(p.name for p in faults.iterdir())
    if log.returncode and not bad:
        bad = [f"ended with status {log.returncode}, see {FOLDER / 'faults' / reader}.log"]
    if not bad:
        keep_what_adds(reader, corpus)
    return int(done[1]) if done else 0, int(edges[-1]) if edges else 0, bad


def keep_what_adds(reader, corpus):
    """The fewest and shortest inputs that reach what all reach."""
    fewer = corpus.with_name(f"{reader}.fewer")
    shutil.rmtree(fewer, ignore_errors=True)
    fewer.mkdir()
    if libfuzzer(reader, ["-merge=1", "-timeout=2", fewer, corpus]).returncode == 0:
        shutil.rmtree(corpus)
        fewer.rename(corpus)


def libfuzzer(reader, arguments):
    environment = dict(
        os.environ,
        ASAN_OPTIONS="detect_leaks=0:quarantine_size_mb=16:malloc_context_size=2:allocator_may_return_null=1",
        UBSAN_OPTIONS="halt_on_error=1",
    )
    return subprocess.run(
        [FOLDER / "fuzz" / f"fuzz_{reader}", *arguments],
        env=environment,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        errors="replace",
    )


def seeds(reader):
    paths = sorted(path for pattern in READERS[reader][1] for path in ROOT.glob(pattern))
    if not paths:
        raise BadInput(f"{reader}: no seed; mend the patterns in tools/fuzz.py")
    return paths


def shortened(path, reader):
    """A file's beginning; of one that is nothing unless whole, what is left with two entries a list."""
    text = path.read_bytes()
    if path.suffix == ".json":
        return json.dumps(two_entries(json.loads(text))).encode()
    if reader in WHOLE or len(text) <= MOST_SEED:
        return text
    return text[: text.rfind(b"\n", 0, MOST_SEED) + 1]


def two_entries(value):
    if isinstance(value, list):
        return [two_entries(v) for v in value[:2]]
    return {k: two_entries(v) for k, v in value.items()} if isinstance(value, dict) else value


def main():
    return command_line.run("fuzz", __doc__, add_options, work)
