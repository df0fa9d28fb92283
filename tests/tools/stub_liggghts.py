#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Stands in for liggghts where only the run folder matters (kill_test.py): a mixer record from a formula, slowly, with the rules of
our own run folders: NAME.partial while it runs, a second process refused, restarts, -var resume yes, renamed at the end.
   stub_liggghts.py -log none -in in.mixer -var NAME VALUE ...     VIELTO_STUB_SECONDS: of one run"""
import fcntl
import json
import math
import os
import pathlib
import shlex
import shutil
import sys
import time

var = {sys.argv[i + 1]: sys.argv[i + 2] for i, word in enumerate(sys.argv) if word == "-var"}
run = pathlib.Path(var["run"])
partial = run.with_name(run.name + ".partial")
rows_per_turn, turns, steps = 12, 6, 10
speed, fill, seed = float(var.get("speed", 1)), float(var.get("fill", 0.15)), int(var.get("seed", 1))


def stop(line):
    sys.exit(f"ERROR: vielto: {line}")


def newest_restart():
    last = max(
        (int(line.split(",")[0]) for line in record.open() if line[:1].isdigit() and line.endswith("\n")), default=0
    )
    return max((int(p.stem) for p in (partial / "restart").glob("*.restart") if int(p.stem) < last), default=None)


if run.exists():
    stop(f"the run folder {run} is there already")
resume = var.get("resume") == "yes"
if resume and not (partial / "run.json").exists():
    stop(f"cannot resume {partial}: it does not exist")
partial.mkdir(parents=True, exist_ok=True)
lock = open(partial / "in_use", "w")
try:
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
except BlockingIOError:
    stop(f"another run is at work in {partial}")
record = partial / "torque.csv"
first = 0
if resume:
    first = newest_restart() if record.exists() else None
    if first is None:
        stop(f"cannot resume {partial}: it was broken off before the first restart file was complete")
    kept = [
        line
        for line in record.open()
        if line.endswith("\n") and not (line[:1].isdigit() and int(line.split(",")[0]) > first)
    ]
    record.write_text("".join(kept))
else:
    for path in partial.iterdir():
        if path.name != "in_use":
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    (partial / "restart").mkdir()
    hashes = {}
    command = shlex.join(["liggghts", *sys.argv[1:]])
    (partial / "run.json").write_text(
        json.dumps({"command": command, "hashes": hashes, "parameters": var, "versions": {}})
    )
    keys = dict(
        schema=1,
        rig="mixer",
        speed=speed,
        fill=fill,
        slice=0,
        paddles=22,
        seed=seed,
        dt=1 / (speed * rows_per_turn * steps),
    )
    keys.update(
        dt_over_tc=0.04,
        steps_per_turn=rows_per_turn * steps,
        interval_steps=steps,
        material="hulled_millet",
        provisional=0,
    )
    keys.update(bulk_density=825, bulk_cohesion=6175, power_lever=0.114, drum_volume=0.0474)
    keys.update(mass_kg=fill * 825 * 0.0474, mass_target_kg=fill * 825 * 0.0474)
    keys.update(paddle_angles_deg="", clearance=0.001, paddle_handing="uniform", paddle_angle_step_deg=90)
    parts = ["paddles", "stems", "shaft", "drum"]
    names = (
        ["step", "time_s", "turn", "idle_Nm"]
        + [p + "_Nm" for p in parts]
        + [f"{p}_F{a}_N" for p in parts for a in "xyz"]
    )
    names += ["overlap_mean", "overlap_max", "contacts", "grains", "kinetic_J"]
    record.write_text(
        "".join(f"# {k}={v:.12g}\n" if isinstance(v, float) else f"# {k}={v}\n" for k, v in keys.items())
        + ",".join(names)
        + "\n"
    )
with record.open("a") as out:
    for row in range(first // steps, rows_per_turn * turns):
        time.sleep(float(os.environ.get("VIELTO_STUB_SECONDS", 1)) / (rows_per_turn * turns))
        turn = (row + 1) / rows_per_turn
        # any function of the row, so that a row lost or doubled shows
        torque = 3 * fill * speed + 0.1 * math.sin(97 * row + seed)
        values = [(row + 1) * steps, turn / speed, turn, 0.6 + 0.01 * math.sin(row)]
        values += [torque, 0.1, 0.05, -0.4] + [0] * 12 + [0.001, 0.01, 400, 180 if fill else 0, 0.01]
        out.write(",".join(f"{v:.10g}" for v in values) + "\n")
        out.flush()
        if (row + 1) % rows_per_turn == 0:
            (partial / "restart" / f"{(row + 1) * steps}.restart").write_text("state\n")
(partial / "in_use").unlink()
partial.rename(run)
