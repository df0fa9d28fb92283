# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/campaign through its command line: a study of small mixer runs; killed with all that it started, and called
again, it ends with the same tables to the last digit; bad studies are refused.
   campaign_test.py BIN    folder of our liggghts and vielto"""
import hashlib
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(sys.argv[1])
STUDY = """run,rig,speed,fill,grainDiameter,youngsModulus,wall_youngsModulus,maxOverlap,settleTime,turns,seed
slow,mixer,1.0,0.05,0.016,2e5,2e5,0.2,0.2,3,1
fast,mixer,1.5,0.05,0.016,2e5,2e5,0.2,0.2,3,1
"""


def campaign(table, out):
    return [ROOT / "scripts/campaign", table, "--out", out, "--bin", BIN, "--cores", "2", "--every", "2"]


def running(pattern):
    """Command lines of processes, one a line."""
    return subprocess.run(["pgrep", "-af", pattern], capture_output=True, text=True).stdout


def tables(out):
    # conditions and values; not the lines that tell when a run was made
    return {name: (out / name).read_text() for name in ("observations.csv", "runs.csv")}


if not shutil.which("snakemake"):
    sys.exit(77)
sys.path.insert(0, str(ROOT))
from tools import rigs  # noqa: E402
from tools.campaign import finished  # noqa: E402


RIG_OF = rigs.read()


def work(point):
    return RIG_OF[point["rig"]].work(point)


def share(faster, slower):
    return work(slower) / work(faster)


# what the time left rests on: grains times steps
bed = {"rig": "shearbox", "bed": "a"}
assert abs(share({**bed, "shearVelocity": "0.05"}, {**bed, "shearVelocity": "0.005"}) - 10) < 1e-9
assert share(bed, {"rig": "shearbox"}) > 1  # which fills a bed of its own
mixer = {"rig": "mixer", "grainDiameter": "0.012"}
assert abs(share(mixer, {**mixer, "slicePaddles": "0"}) - 22 / 4) < 1e-9
assert abs(share(mixer, {**mixer, "grainDiameter": "0.006", "speed": "0.5"}) - 32) < 1e-9
assert share({"rig": "repose"}, {"rig": "repose", "liftSpeed": "0.01"}) > 1.5
# the mixer's two rows of doc/reference/cost.md, 20 and 3 to 4 minutes of one core
assert abs(rigs.SECONDS_OF_WORK * work({"rig": "mixer"}) / 60 - 20) < 1
assert 3 <= rigs.SECONDS_OF_WORK * work(mixer) / 60 <= 4
machine = {"rig": "machine", "vesselVolume": "0.01"}
assert abs(share(machine, {**machine, "vesselVolume": "0.02", "fill": "0.6"}) - 4) < 1e-9
assert abs(share({"rig": "drum"}, {"rig": "drum", "fill": "0.25"}) - 0.5) < 1e-9
with tempfile.TemporaryDirectory(prefix="vielto-campaign-") as name:
    folder = pathlib.Path(name)
    (folder / "runs").mkdir()
    (folder / "runs/a.log").write_text(
        "run 1 of 1\ndisplacement 1.7 of 8.0 mm, 0:18 left\ndisplacement 2.0 of 8.0 mm, shear force 9 N, 0:15 left\n"
    )
    assert (
        abs(finished.share_done(folder, {"run": "a"}) - 0.25) < 1e-9 and finished.share_done(folder, {"run": "b"}) == 0
    )
    # a machine's run is out of date when one of its STL files is another; a blank in their path is none
    own = folder / "my mixer"
    own.mkdir()
    (own / "drum.stl").write_text("solid")
    point = {"run": "m", "rig": "machine", "parts": str(own / "machine.toml")}
    (folder / "runs/m").mkdir()
    (folder / "runs/m/run.json").write_text(
        json.dumps(
            {
                "command": f"liggghts -in in.machine -var parts '{own / 'machine.toml'}'",
                "hashes": {str(own / "drum.stl"): hashlib.sha256(b"solid").hexdigest()},
            }
        )
    )
    assert list(finished.stale_runs(RIG_OF, folder, [point])) == []
    (own / "drum.stl").write_text("other")
    ((run, why),) = finished.stale_runs(RIG_OF, folder, [point])
    assert run == "m" and "drum.stl" in why, why
    study = folder / "study.csv"
    study.write_text(STUDY)
    whole = subprocess.run(campaign(study, folder / "whole"), capture_output=True, text=True)
    assert whole.returncode == 0, whole.stdout + whole.stderr + (folder / "whole/snakemake.log").read_text()
    assert "100 % of the work" in whole.stdout, whole.stdout
    rows = (folder / "whole/observations.csv").read_text().splitlines()
    assert (
        sum(line.startswith("slow,") for line in rows) >= 1 and sum(line.startswith("fast,") for line in rows) >= 1
    ), rows

    out = folder / "killed"
    started = subprocess.Popen(campaign(study, out), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    record = out / "runs/slow.partial/torque.csv"
    for _ in range(600):
        if record.exists() and sum(line[:1].isdigit() for line in record.open()) > 100:
            break
        time.sleep(0.1)
    else:
        sys.exit(f"no record of the run to kill: {started.communicate(timeout=1)}")
    subprocess.run(["pkill", "-KILL", "-f", str(out)])
    started.wait()
    for _ in range(100):
        if not running(str(out)):
            break
        time.sleep(0.1)
    assert not (out / "observations.csv").exists()
    assert record.exists()
    # told to end, it ends with all that it started
    told = subprocess.Popen(campaign(study, out), stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
    for _ in range(600):
        if running(f"liggghts.*{out}"):
            break
        time.sleep(0.1)
    told.terminate()
    assert told.wait(20) == 130, told.returncode
    time.sleep(0.5)
    assert not running(str(out)), running(str(out))
    again = subprocess.run(campaign(study, out), capture_output=True, text=True)
    assert again.returncode == 0, again.stdout + again.stderr + (out / "snakemake.log").read_text()
    assert tables(out) == tables(folder / "whole")
    # a study that has changed is not given the old runs' numbers
    study.write_text(STUDY.replace("fast,mixer,1.5,0.05", "fast,mixer,1.5,0.06"))
    changed = subprocess.run(campaign(study, out), capture_output=True, text=True)
    assert (
        changed.returncode == 2 and "finished runs out of date: 1; fast was made with fill 0.05" in changed.stderr
    ), changed.stderr
    assert tables(out) == tables(folder / "whole")
    again = subprocess.run([*campaign(study, out), "--again"], capture_output=True, text=True)
    assert again.returncode == 0, again.stdout + again.stderr
    assert ",0.06," in (out / "observations.csv").read_text() and tables(out) != tables(folder / "whole")
    # nor one whose script is another by now
    made = out / "runs/slow/run.json"
    made.write_text(made.read_text().replace('"in.mixer": "', '"in.mixer": "0'))
    other = subprocess.run(campaign(study, out), capture_output=True, text=True)
    assert other.returncode == 2 and "slow was made from another cases/mixer/in.mixer" in other.stderr, other.stderr
    study.write_text(STUDY)
    # in portions: the table of the second holds the first
    one = subprocess.run([*campaign(study, folder / "parts"), "--only", "fast"], capture_output=True, text=True)
    assert one.returncode == 0, one.stdout + one.stderr
    assert not any(line.startswith("slow,") for line in (folder / "parts/observations.csv").open())
    rest = subprocess.run([*campaign(study, folder / "parts"), "--only", "slow"], capture_output=True, text=True)
    assert rest.returncode == 0 and tables(folder / "parts") == tables(folder / "whole"), rest.stdout + rest.stderr
    # a shear run takes the bed of another, which comes first wherever it stands; in a portion too
    study.write_text(
        "run,rig,shearVelocity,bed,grainDiameter,youngsModulus,wall_youngsModulus,normalStress,settleTime,loadTime,maxPlateError,maxOverlap,displacement\n"
        "slow_a,shearbox,0.1,fast_b,0.006,1e6,1e6,1961,0.12,0.06,0.5,0.5,0.004\nfast_b,shearbox,0.2,,0.006,1e6,1e6,1961,0.12,0.06,0.5,0.5,0.004\n"
    )
    beds = subprocess.run([*campaign(study, folder / "beds"), "--only", "_a"], capture_output=True, text=True)
    assert beds.returncode == 0, beds.stdout + beds.stderr + (folder / "beds/snakemake.log").read_text()
    filled = [(folder / "beds/runs" / run / "bed.restart").exists() for run in ("slow_a", "fast_b")]
    assert filled == [False, True], filled
    # one that stops by itself is named; the tables hold the others
    study.write_text(
        STUDY.splitlines()[0] + "\n" + STUDY.splitlines()[2] + "\nwedged,mixer,1.5,0.05,0.016,2e5,2e5,1e-6,0.2,3,1\n"
    )
    part = subprocess.run(campaign(study, folder / "wedged"), capture_output=True, text=True)
    assert part.returncode == 1 and "not in the tables: wedged; " in part.stderr, part
    held = (folder / "wedged/runs.csv").read_text().splitlines()
    assert len(held) == 2 and held[1].startswith("fast,"), held
    # nothing to do any more
    study.write_text(STUDY)
    before = tables(folder / "whole")
    third = subprocess.run(campaign(study, folder / "whole"), capture_output=True, text=True)
    assert third.returncode == 0 and tables(folder / "whole") == before, third.stdout + third.stderr

    for text, fault in (
        ("run,rig,seed\na,mill,1\n", ":2: a run needs a name in `run` and one of mixer, shearbox, repose"),
        ("run,rig,seed\na,mixer,1\na,mixer,2\n", ":3: a is there twice"),
        ("run,rig,bed\na,shearbox,b\n", ":2: bed b is no run of this study"),
        ("run,rig,seed\na,mixer\n", ":2: has not as many cells as the header"),
        ("run,rig,seed\nidle_1,mixer,1\n", ":2: 'idle_1' is no name for a run"),
        ("run,rig,seed\na b,mixer,1\n", ":2: 'a b' is no name for a run"),
        ("run,rig,seed\n", "holds no row"),
    ):
        study.write_text(text)
        refused = subprocess.run(campaign(study, folder / "bad"), capture_output=True, text=True)
        assert refused.returncode == 2 and fault in refused.stderr, refused
        assert not (folder / "bad").exists()
    study.write_bytes(bytes(range(256)))
    for words, fault in (
        ((study, folder / "bad"), "is no CSV table"),
        ((folder, folder / "bad"), "there is no study"),
        ((folder / "none.csv", folder / "bad"), "none.csv: No such file or directory; give `run,rig`"),
        (("none", folder / "bad"), "known: calibration"),
        (("grid", study), "cannot be made"),
    ):
        refused = subprocess.run(campaign(*words), capture_output=True, text=True)
        assert refused.returncode == 2 and fault in refused.stderr and refused.stderr.count("\n") == 1, refused
    none = subprocess.run([*campaign("grid", folder / "bad"), "--cores", "0"], capture_output=True, text=True)
    assert none.returncode == 2 and "'0' is no number of runs" in none.stderr, none
    missing = subprocess.run(campaign("nonsense", folder / "bad"), capture_output=True, text=True)
    assert (
        missing.returncode == 2 and "there is no study nonsense; known: " in missing.stderr and "grid" in missing.stderr
    ), missing
    assert work({"rig": "mixer", "speed": "0"}) == 0 and work({"rig": "mixer", "youngsModulus": "-1"}) == 0
    study.write_text("run,rig,speed\na,mixer,-1\n")
    failed = subprocess.run(campaign(study, folder / "failed"), capture_output=True, text=True)
    assert failed.returncode == 1 and "not all runs ended well" in failed.stderr, failed
    assert "speed is -1" in (folder / "failed/snakemake.log").read_text()
    assert not (folder / "failed/observations.csv").exists()
