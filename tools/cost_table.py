# SPDX-License-Identifier: GPL-2.0-or-later
"""What one turn of the mixer costs: seconds against grain size, E and time step, on two ranks, with the overlaps that come
with it (here without the rig's limit).

  scripts/cost-table [--out FILE]

Writes doc/reference/cost.csv row by row; rows that are there are not run again, so that a call that was broken off goes on.
"""
import os
import pathlib
import re
import subprocess
import tempfile

from tools import ROOT, tables
from tools.errors import RunFailed
from tools.progress import Progress

HEADER = ["grain_diameter_m", "youngs_modulus_Pa", "dt_over_tc", "grains", "steps_per_turn", "seconds_per_turn"]
HEADER += ["particle_steps_per_s", "overlap_mean", "overlap_max"]
# one change at a time around 10 mm, 1 MPa, 1/20
POINTS = [(d, "1e6", "0.05") for d in ("0.012", "0.010", "0.008", "0.006")]
POINTS += [("0.010", "2.5e5", "0.05"), ("0.010", "4e6", "0.05"), ("0.010", "1e6", "0.025")]
TURNS = 0.25
RANKS = 2


def add_options(parser):
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "doc/reference/cost.csv", metavar="FILE")


def work(options):
    rows = list(tables.read(options.out, HEADER, "remove it", may_be_empty=True)) if options.out.exists() else []
    there = {tuple(row[c] for c in HEADER[:3]) for row in rows}
    waiting = [point for point in POINTS if point not in there]
    if waiting:
        subprocess.run([ROOT / "scripts/build", "release", "vielto", "vielto_run"], check=True)
    progress = Progress("points run", len(waiting), every=0)
    for point in waiting:
        with tempfile.TemporaryDirectory(prefix="vielto-cost-") as folder:
            seconds = run(pathlib.Path(folder), *point)
            rows.append(row_of(point, pathlib.Path(folder, "run/torque.csv"), seconds))
        tables.write(options.out, HEADER, rows)
        print(*(rows[-1][c] for c in HEADER), sep=",", flush=True)
        progress.step()


def run(folder, diameter, modulus, fraction):
    """Simulates a quarter of a turn into folder/run; its seconds."""
    settings = {
        "run": folder / "run",
        "grainDiameter": diameter,
        "youngsModulus": modulus,
        "wall_youngsModulus": modulus,
        "dtFraction": fraction,
        "turns": TURNS,
        "restartTurns": 0,
        "settleTime": 0.35,
        "maxOverlap": 0.3,
    }
    words = ["mpirun", "--mca", "mpi_yield_when_idle", "1", "--oversubscribe", "-np", str(RANKS)]
    words += ["liggghts", "-in", "in.mixer"]
    for name, value in settings.items():
        words += ["-var", name, str(value)]
    env = dict(
        os.environ,
        PATH=f"{ROOT / 'build/bin'}:{os.environ['PATH']}",
        OMPI_ALLOW_RUN_AS_ROOT="1",
        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    )
    done = subprocess.run(
        words, cwd=ROOT / "cases/mixer", env=env, capture_output=True, text=True, errors="replace", check=False
    )
    took = re.findall(r"^Loop time of (\S+)", done.stdout, re.M)
    if done.returncode or not took:
        told = re.findall(r"^(?:vielto:|ERROR).*$", done.stdout + done.stderr, re.M) or done.stdout.splitlines()[-5:]
        raise RunFailed(f"grain {diameter} m, E {modulus} Pa, dt/t_c {fraction}: " + " ".join(told))
    return float(took[-1])


def row_of(point, path, seconds):
    header, record = tables.read_record(path)
    steps, grains = int(header["steps_per_turn"]), int(record[-1].number("grains"))
    overlaps = [row.number("overlap_mean") for row in record]
    cells = [
        *point,
        grains,
        steps,
        f"{seconds / TURNS:.1f}",
        f"{grains * steps * TURNS / seconds:.3g}",
        f"{sum(overlaps) / len(overlaps):.3g}",
        f"{max(row.number('overlap_max') for row in record):.3g}",
    ]
    return dict(zip(HEADER, cells))
