#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""kill -9 at random moments: scripts/campaign and `vielto gap confirm --run`, called again after each, end with the tables of a call
that nobody killed. What is killed is the command alone, or all that it has started as well, in turn.
   kill_test.py BIN TOY_LIBRARY [--times N] [--only campaign|confirm]
       folder of our vielto; program gap_toy_library; kills of each (default 4)
liggghts is a stand-in here (stub_liggghts.py), which obeys the rules of run folders; campaign_test.py kills the real one."""
import argparse
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = "run,rig,speed,fill,restartTurns\n" + "".join(f"r{i},mixer,{0.5 + 0.25 * i},0.15,1\n" for i in range(2))
SECONDS = "0.15"  # of a run: short, so that many of the moments lie where one ends and the next begins

parser = argparse.ArgumentParser()
parser.add_argument("bin", type=pathlib.Path)
parser.add_argument("toy_library", type=pathlib.Path)
parser.add_argument("--times", type=int, default=4)
parser.add_argument("--only", choices=["campaign", "confirm"])
parser.add_argument("--seed", type=int, default=1)
options = parser.parse_args()
if not shutil.which("snakemake"):
    sys.exit(77)
chance = random.Random(options.seed)


def descendants(pid):
    """Of a process, however deep; a grandchild whose parent has ended belongs to another."""
    children = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            words = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        children.setdefault(int(words[1]), []).append(int(stat.parent.name))
    found = [pid]
    for process in found:
        found += children.get(process, [])
    return found


def kill(process, all_of_it):
    for pid in descendants(process.pid) if all_of_it else [process.pid]:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.wait()


def killed_and_called_again(name, command, environment, table, empty):
    """Kills `times` calls, each at a random moment; one that ends before its moment must have the right table."""
    if options.only not in (None, name):
        return
    start = time.monotonic()
    whole = empty()
    subprocess.run(command(whole), env=environment, check=True, capture_output=True)
    expected, took = table(whole), time.monotonic() - start
    assert expected.strip(), name
    kills = ended = 0
    folder = empty()
    while kills < options.times:
        process = subprocess.Popen(command(folder), env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        try:
            process.wait(chance.uniform(0, 1.1 * took))
        except subprocess.TimeoutExpired:
            kill(process, all_of_it=kills % 2 == 0)
            kills += 1
            if kills % 10 == 0:
                print(f"{name}: {kills} kills, {time.monotonic() - start:.0f} s", flush=True)
            continue
        assert process.returncode == 0, f"{name} after {kills} kills: {process.stderr.read().decode()}"
        assert table(folder) == expected, f"{name} after {kills} kills: another table"
        ended += 1
        folder = empty()  # killed anew from the beginning
    last = subprocess.run(command(folder), env=environment, capture_output=True, text=True)
    assert last.returncode == 0, f"{name} after {kills} kills: {last.stderr}"
    assert table(folder) == expected, f"{name} after {kills} kills: another table"
    print(f"{name}: {kills} kills, {ended + 1} times ended, the same table each time", flush=True)


with tempfile.TemporaryDirectory(prefix="vielto-kill-") as name:
    folder = pathlib.Path(name)
    programs = folder / "bin"
    programs.mkdir()
    (programs / "liggghts").symlink_to(ROOT / "tests/tools/stub_liggghts.py")
    (programs / "vielto").symlink_to(options.bin.resolve() / "vielto")
    environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", VIELTO_STUB_SECONDS=SECONDS)
    made = 0

    def empty():
        global made
        made += 1
        return folder / f"out{made}"

    study = folder / "study.csv"
    study.write_text(STUDY)
    killed_and_called_again(
        "campaign",
        lambda out: [ROOT / "scripts/campaign", study, "--out", out, "--bin", programs, "--cores", "2", "--every", "1"],
        environment,
        lambda out: (out / "observations.csv").read_text() + (out / "runs.csv").read_text(),
        empty,
    )

    libraries = folder / "libraries"
    libraries.mkdir()
    shutil.copytree(ROOT / "libraries/effects", libraries / "effects")
    for path in (ROOT / "libraries").glob("*.toml"):
        shutil.copy(path, libraries)
    subprocess.run([options.toy_library, folder, "0"], check=True)
    # of the toy's tests the powers, a level apart from the simulation, one of them to check
    rows = (folder / "tests.csv").read_text().splitlines()
    table = [rows[0]]
    for row in rows[1:]:
        cells = row.split(",")
        if cells[3] != "power" or cells[1] == "check" and cells[7] != "1":
            continue
        cells[4] = f"{float(cells[4]) * 1.6:.9g}"
        table.append(",".join(cells))
    (folder / "tests.csv").write_text("\n".join(table) + "\n")

    def shrink(out):
        import json

        d = json.loads((out / "diagnosis.json").read_text())
        assert d["shrink"], d["sentence"]
        return json.dumps([d["verdict"], d["probabilities"], d["shrink"]])

    killed_and_called_again(
        "confirm",
        lambda out: [programs / "vielto", "gap", "confirm", folder / "tests.csv", "--library", libraries / "millet"]
        + ["--draws", "20", "--run", "--jobs", "2", "--root", ROOT, "--out", out, "--runs", str(out) + "_runs"],
        environment,
        shrink,
        empty,
    )
