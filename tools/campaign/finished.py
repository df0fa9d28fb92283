# SPDX-License-Identifier: GPL-2.0-or-later
"""What of a campaign is done: shares of the work, runs that are out of date, the tables of all."""
import hashlib
import json
import os
import re
import shlex
import shutil

from tools import ROOT, files, tables


def share_done(out, point):
    """Part of a run that is done, as its own last line of progress tells: `turn 1.5 of 6, ...`."""
    if (out / "done" / point["run"]).exists():
        return 1.0
    log = out / "runs" / (point["run"] + ".log")
    try:
        with open(log, "rb") as file:
            file.seek(max(0, os.path.getsize(log) - 4000))
            done, of = re.findall(r"^\w+ ([\d.]+) of ([\d.]+)", file.read().decode(), re.M)[-1]
        return min(0.99, float(done) / float(of))
    except (OSError, ValueError, IndexError, ZeroDivisionError):
        return 0.0


def work_done(rigs, out, points):
    """Work of the runs, in any unit: (done, in all)."""
    work = {p["run"]: rigs[p["rig"]].work(p) for p in points}
    return sum(work[p["run"]] * share_done(out, p) for p in points), sum(work.values()) or 1.0


def stale_runs(rigs, out, points):
    """(run, why) of finished runs that were made from other files or with other settings than there are now."""
    now = {}
    for point in points:
        try:
            made = json.loads((out / "runs" / point["run"] / "run.json").read_text())
        except (OSError, ValueError):
            continue
        why = _other_settings(point, made) or _other_file(rigs[point["rig"]], point, made, now)
        if why:
            yield point["run"], why


def _other_settings(point, made):
    words = shlex.split(made["command"])
    said = dict(zip(words, words[1:]))  # a name of a -var is followed by its value
    for name, value in point.items():
        if name not in ("run", "rig", "bed") and said.get(name) != value:
            return f"with {name} {said.get(name, 'as the rig has it')}, the study now has {value}"
    return None


def _other_file(rig, point, made, now):
    """`now` remembers the files' hashes."""
    if point.get("materials"):
        return None
    for name, known in made["hashes"].items():
        path = _file_of(name, rig)
        if path is None:
            continue
        if path not in now:
            now[path] = hashlib.sha256(path.read_bytes()).hexdigest()
        if now[path] != known:
            return f"from another {os.path.relpath(path, ROOT)}"
    return None


def _file_of(name, rig):
    """The file of a run's hash: run.json has its path from the rig's folder."""
    path = (rig.script.parent / name).resolve()
    return path if path.exists() else None


def forget(out, run):
    shutil.rmtree(out / "runs" / run, ignore_errors=True)
    for path in (out / "done" / run, out / "post" / f"{run}.csv", out / "post" / f"{run}.csv.txt"):
        path.unlink(missing_ok=True)


def gather(rigs, out, study):
    """observations.csv and runs.csv (all that post tells, a row a run) of the runs that are there; the others' names."""
    header, observations, runs, missing = [], [], [], set()
    for point in study:
        path = out / "post" / f"{point['run']}.csv"
        if not path.exists():
            missing.add(point["run"])
            continue
        table = tables.read(path, ["test"], "remove it and call the campaign again", may_be_empty=True)
        header = table.header
        observations += table
        result = rigs[point["rig"]].result
        runs.append({**point, **(_told(out / "runs" / point["run"] / "post" / result) if result else {})})
    if runs:
        tables.write(out / "observations.csv", header, observations)
        tables.write(out / "runs.csv", list(dict.fromkeys(k for row in runs for k in row)), runs)
    return missing


def _told(path):
    """All single numbers and words of a result."""
    told = files.read_json(path, "remove its run and call the campaign again")
    told.update(told.pop("quality", {}))
    told.update({f"loss_{k}_W": v["power_W"] for k, v in (told.pop("losses", None) or {}).items()})
    return {k: v for k, v in told.items() if not isinstance(v, (dict, list))}
