# SPDX-License-Identifier: GPL-2.0-or-later
"""The command scripts/campaign."""
import argparse
import contextlib
import fcntl
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

from tools import ROOT, campaign, command_line, rigs
from tools.campaign import finished, study
from tools.errors import BadInput, RunFailed

HERE = pathlib.Path(__file__).resolve().parent


def main():
    return command_line.run("campaign", campaign.__doc__, add_options, work)


def at_least_one(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of runs; give 1 or more")
    return int(text)


def add_options(parser):
    parser.add_argument("study", help="name of a table in studies, without .csv, or a table's path")
    parser.add_argument("--out", type=pathlib.Path, help="folder of runs and tables, default results/studies/NAME")
    parser.add_argument("--bin", type=pathlib.Path, help="folder of our liggghts and vielto; default: they are built")
    parser.add_argument("--cores", type=at_least_one, default=os.cpu_count(), help="runs at a time on this machine")
    parser.add_argument("--slurm", action="store_true", help="submit the runs to Slurm with sbatch")
    parser.add_argument(
        "--only", default="", metavar="END", help="runs whose names end so, for a study in portions: _s1"
    )
    parser.add_argument(
        "--again", action="store_true", help="make runs anew that were made from other files or settings"
    )
    parser.add_argument("--rigs", type=pathlib.Path, metavar="FILE", help="table of rigs of your own (cases/rigs.toml)")
    parser.add_argument("--estimate", action="store_true", help="say what the study costs, and run nothing")
    parser.add_argument("--every", type=float, default=60, help="seconds between two lines of progress")


def work(options):
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # told to end is interrupted
    table = pathlib.Path(study.find(options.study)).resolve()
    if options.slurm and not shutil.which("sbatch"):
        raise BadInput("--slurm needs sbatch, which is not on the PATH; install slurm-client or leave --slurm out")
    known = rigs.read(options.rigs)
    every = study.read(table, known)
    points = [p for p in every if p["run"].endswith(options.only)]
    if not points:
        raise BadInput(f"no run of {table} ends in {options.only}; --only takes the end of runs' names")
    if options.estimate:
        return tell_cost(known, points, options.cores)
    options.bin = options.bin or programs()
    out = (options.out or ROOT / "results/studies" / table.stem).resolve()
    if re.search(r"[\s'\"$#&*{}]", str(out)):
        raise BadInput(
            f"{out}: LIGGGHTS reads no folder with blanks or any of '\"$#&* in its name; state another with --out"
        )
    with alone(out) as lock:
        make_ready(known, out, points, options.again)
        status = run_all(known, out, points, options, table, lock)
        missing = finished.gather(known, out, every) & {p["run"] for p in points}
    if (out / "observations.csv").exists():
        print(f"table: {os.path.relpath(out / 'observations.csv')}")
    if status or missing:
        lacking = f"; not in the tables: {', '.join(sorted(missing))}" if missing else ""
        raise RunFailed(f"not all runs ended well{lacking}; {out / 'snakemake.log'} tells why")
    return 0


def tell_cost(known, points, cores):
    """Of all runs and of the dearest one, by the rigs' `work`."""
    seconds = {p["run"]: rigs.SECONDS_OF_WORK * known[p["rig"]].work(p) for p in points}
    dearest = max(seconds, key=seconds.get)
    total = sum(seconds.values())
    print(
        f"{len(points)} runs, about {total / 3600:.2g} core-hours, {total / 3600 / min(cores, len(points)):.2g} hours on "
        f"{cores} cores; the dearest, {dearest}, about {seconds[dearest] / 60:.2g} minutes of one core "
        "(a core of 2 GHz, to a factor of two: doc/reference/cost.md)"
    )
    unknown = [run for run, cost in seconds.items() if cost == 0]
    if unknown:
        print(f"not in it, since their rig states no `work` for them: {len(unknown)} runs, {unknown[0]} first")
    return 0


def programs():
    """The folder of our liggghts and vielto: built in a repository; in a copy of the cases (`vielto copy`) what is installed."""
    if (ROOT / "CMakeLists.txt").exists():
        subprocess.run([ROOT / "scripts/install-packages", "demo", "campaign"], check=True)
        subprocess.run([ROOT / "scripts/build", "release", "vielto", "vielto_run"], check=True)
        return ROOT / "build/bin"
    vielto = shutil.which("vielto")
    if not vielto:
        raise BadInput("vielto is not on the PATH; add the installation's bin folder, or state --bin")
    if not shutil.which("snakemake"):
        raise BadInput("snakemake is not installed; apt-get install snakemake")
    prefix = pathlib.Path(vielto).resolve().parents[1]
    for folder in [*prefix.glob("lib/vielto/bin"), *prefix.glob("lib/*/vielto/bin")]:
        if (folder / "liggghts").exists():
            return folder
    raise BadInput(f"{prefix}: no liggghts of vielto is installed there; state its folder with --bin")


@contextlib.contextmanager
def alone(out):
    """The folder for this campaign alone: of another one, or of what a killed one has left at work, the end is waited for."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        lock = open(out / "campaign.lock", "w")
    except OSError as e:
        raise BadInput(f"{out}: cannot be made: {e.strerror}; state another folder with --out")
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(f"{out}: a campaign is at work there; waiting for its end", flush=True)
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield lock


def make_ready(known, out, points, again):
    """The folder without runs that are out of date and without the tables, which are made at the end."""
    stale = list(finished.stale_runs(known, out, points))
    if stale and not again:
        raise BadInput(
            f"{out}: finished runs out of date: {len(stale)}; {stale[0][0]} was made {stale[0][1]}; "
            "--again makes them anew, or move the folder away"
        )
    for run, _ in stale:
        finished.forget(out, run)
    for name in ("observations.csv", "runs.csv"):
        (out / name).unlink(missing_ok=True)


def run_all(known, out, points, options, table, lock):
    """Snakemake's exit status."""
    command = ["snakemake", "--snakefile", HERE / "Snakefile", "--directory", out]
    command += ["--config", f"table={table}", f"out={out}", *([f"only={options.only}"] if options.only else [])]
    command += [f"rigs={options.rigs.resolve()}"] if options.rigs else []
    command += ["--nolock", "--rerun-incomplete", "--rerun-triggers", "mtime", "--keep-going", "--quiet", "all"]
    command += ["--profile", HERE / "slurm"] if options.slurm else ["--cores", str(options.cores)]
    env = dict(
        os.environ,
        PATH=f"{options.bin.resolve()}:{os.environ['PATH']}",
        OMPI_ALLOW_RUN_AS_ROOT="1",
        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    )
    started, (first, _) = time.time(), finished.work_done(known, out, points)
    engine = None
    try:
        with open(out / "snakemake.log", "a") as log:
            # in a session of its own: when this command is told to end, all that it started ends with it
            engine = subprocess.Popen(
                command, env=env, stdout=log, stderr=log, start_new_session=True, pass_fds=[lock.fileno()]
            )
        while engine.poll() is None:
            tell_progress(known, out, points, started, first)
            try:
                engine.wait(options.every)
            except subprocess.TimeoutExpired:
                pass
    except KeyboardInterrupt:
        if engine:
            os.killpg(engine.pid, signal.SIGKILL)  # runs begin anew or go on from a restart, as after any kill
            engine.wait()
        raise
    tell_progress(known, out, points, started, first)
    return engine.returncode


def tell_progress(known, out, points, started, first):
    done, total = finished.work_done(known, out, points)
    ended = sum((out / "done" / p["run"]).exists() for p in points)
    minutes = (time.time() - started) * (total - done) / (done - first) / 60 if done > first else None
    left = "" if minutes is None else f", {minutes:.0f} min left"
    print(f"{ended} of {len(points)} runs, {100 * done / total:.0f} % of the work{left}", flush=True)
