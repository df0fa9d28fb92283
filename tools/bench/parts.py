# SPDX-License-Identifier: GPL-2.0-or-later
"""The parts of the benchmark. Each takes (folder, quick, pairs) and returns what it adds to the results."""
import csv
import json
import math
import os
import pathlib
import resource
import statistics
import subprocess

from tools import files
from tools.bench import packing
from tools.bench.stepping import BIN, ENV, ROOT, Engine, Lammps, Yade, make_bed

# What the law has to move, at least: of a contact its seven history values read and written, its touch flag read and
# written, the neighbour's index; of a grain x, v, omega, radius, mass, type once, force and torque read and written.
CONTACT_BYTES = 2 * 7 * 8 + 2 * 4 + 4
GRAIN_BYTES = 11 * 8 + 4 + 2 * 6 * 8
PATH_ENV = dict(ENV, PATH=f"{BIN}:{os.environ['PATH']}")


def law_time(t):
    return t["pair_s"] + t["wall_s"]


def spread(values):
    """Median and its 95 % interval by order statistics."""
    ordered = sorted(values)
    n = len(ordered)
    k = max(0, math.floor(0.5 * n - 0.98 * math.sqrt(n)))
    return {"median": statistics.median(ordered), "low": ordered[k], "high": ordered[n - 1 - k]}


def law(folder, quick, pairs):
    """ViElTo against the stock law with the same ingredients, in the mixer slice."""
    bed = make_bed(folder, d=0.012 if quick else 0.008)
    ours, stock = Engine(folder, law=1, **bed), Engine(folder, law=0, **bed)
    law, step, contacts = [], [], []
    for _ in range(pairs):
        a, b = ours.step(100), stock.step(100)
        law.append(law_time(a) / law_time(b))
        step.append(a["run_s"] / b["run_s"])
        contacts.append((a["pair_contacts"] + a["wall_contacts"]) / (b["pair_contacts"] + b["wall_contacts"]))
    for engine in (ours, stock):
        engine.quit()

    def nanoseconds(t):
        return 1e9 * law_time(t) / t["steps"] / (t["pair_contacts"] + t["wall_contacts"])

    print(
        f"{a['grains']:.0f} grains, {a['pair_contacts']:.0f} + {a['wall_contacts']:.0f} contacts (stock "
        f"{b['pair_contacts']:.0f} + {b['wall_contacts']:.0f}); last pair {nanoseconds(a):.0f} and {nanoseconds(b):.0f} ns a contact"
    )
    return {
        "contact_law_over_stock": spread(law),
        "step_over_stock": spread(step),
        "contacts_over_stock": spread(contacts),
    }


def ranks(folder, quick, pairs):
    """Two ranks against one; memory a grain, against a small bed."""
    # a soft bed of many grains is made quickly; it is timed as it is
    soft = dict(d=0.006, E=1e5) if quick else dict(d=0.0041, E=1e5)
    small = Engine(folder, law=1, **make_bed(folder, turns=0.02, d=0.012, E=1e5), E=1e5)
    few = (small.step(1)["grains"], small.memory)
    small.quit()
    bed = dict(make_bed(folder, turns=0.02, **soft), E=soft["E"])
    one, two = Engine(folder, law=1, **bed), Engine(folder, ranks=2, law=1, **bed)
    gain = [one.step(20)["run_s"] / two.step(20)["run_s"] for _ in range(pairs)]
    many = (one.step(1)["grains"], one.memory)
    for engine in (one, two):
        engine.quit()
    return {
        "ranks2_over_1": dict(spread(gain), grains=many[0]),
        "bytes_per_grain": (many[1] - few[1]) * 1024**2 / (many[0] - few[0]),
    }


def beside_yade(folder, quick, pairs, copies, steps, warm):
    """The stirred drum of yade/stir, this many times as long, in both engines, one core each."""
    import numpy

    from tools.yade import drum, runs

    case = files.read_json(ROOT / "yade/stir/case.json", "bring it back")
    where = pathlib.Path(folder)
    runs.meshes(case, where)
    bed = runs.liggghts(str(BIN / "liggghts"), case, where, drum.random_grains(case, 1), turning=False)
    length = case["drum"]["length"]
    case = dict(case, grains=copies * case["grains"], drum=dict(case["drum"], length=copies * length))
    # grains keep off the ends, so that copies of the bed do not overlap where the ends were
    bed = numpy.concatenate([bed + [k * length, 0, 0] for k in range(copies)])
    runs.meshes(case, where)
    runs.liggghts_files(case, where, bed, turning=True)
    (where / "run.json").write_text(json.dumps(runs.yade_run(case, where, bed)))
    ours, theirs = Engine(folder, script="../yade/stir/in.drum", turning=2), Yade(folder)
    ours.step(warm), theirs.step(warm)
    faster, a, b = [], [], []
    for _ in range(pairs):
        a.append(ours.step(steps[0])), b.append(theirs.step(steps[1]))
        faster.append(b[-1]["run_s"] / b[-1]["steps"] / (a[-1]["run_s"] / a[-1]["steps"]))
    for engine in (ours, theirs):
        engine.quit()

    def mean(ts, name):
        return statistics.mean(t[name] for t in ts)

    def speed(ts):
        return statistics.median(case["grains"] * t["steps"] / t["run_s"] for t in ts)

    return dict(
        spread(faster),
        grains=case["grains"],
        particle_steps_per_s=speed(a),
        yade_particle_steps_per_s=speed(b),
        contacts=[mean(a, "pair_contacts"), mean(a, "wall_contacts")],
        yade_contacts=[mean(b, "pair_contacts"), mean(b, "wall_contacts")],
    )


def yade(folder, quick, pairs):
    """How often as many particle-steps a second as Yade, 600 grains."""
    quarter = 36 * 352 // (16 if quick else 4)
    return {"particle_steps_over_yade": beside_yade(folder, quick, pairs, 1, (200, 50), quarter)}


def yade_10k(folder, quick, pairs):
    """The same with 10 200 grains."""
    return {
        "particle_steps_over_yade_10k": beside_yade(folder, quick, pairs, 2 if quick else 17, (50, 20), 36 * 352 // 16)
    }


def yade_100k(folder, quick, pairs):
    """The same with 102 000 grains; few turns, as a step of Yade takes seconds."""
    turns, copies = (6, 20) if quick else (min(pairs, 12), 170)
    return {"particle_steps_over_yade_100k": beside_yade(folder, quick, turns, copies, (10, 4), 30)}


def grid(folder, quick, pairs):
    """Core minutes of the 4 x 4 grid of speeds and fills in cases/mixer, 8 mm, 6 turns each, by the processor's clock.

    `campaign_minutes` are those of studies/grid_8mm.csv, whose runs end when their power is known, and those of one fill
    share a bed. How many turns they take is chance: the mean over the campaigns `campaigns`. The cost of a step is taken at the least and
    the greatest fill and is linear in the fill between them; that of a turn is its steps times that."""
    speeds, fills, turns = (0.48, 0.85, 1.21, 1.58), (0.10, 0.15, 0.20, 0.25), 6

    def run(fill, length, bed="none"):
        name = pathlib.Path(folder, f"grid_{fill}_{length}_{'new' if bed == 'none' else 'taken'}")
        words = [BIN / "liggghts", "-log", "none", "-in", "in.mixer", "-var", "run", name, "-var", "fill", fill]
        words += [
            "-var",
            "turns",
            length,
            "-var",
            "restartTurns",
            0,
            "-var",
            "grainDiameter",
            0.012 if quick else 0.008,
            "-var",
            "bed",
            bed,
        ]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [str(w) for w in words], cwd=ROOT / "cases/mixer", env=PATH_ENV, check=True, stdout=subprocess.DEVNULL
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        head = dict(
            line[2:].split("=", 1) for line in (name / "torque.csv").read_text().splitlines() if line.startswith("# ")
        )
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return seconds, int(head["steps_per_turn"]), name

    short, long = 0.1, 0.2 if quick else 0.4
    step, filled, taken = {}, {}, {}
    for fill in (fills[0], fills[-1]):
        (few, perTurn, bed), (many, _, _) = run(fill, short), run(fill, long)
        step[fill] = (many - few) / ((long - short) * perTurn)
        filled[fill] = few - short * perTurn * step[fill]
        taken[fill] = run(fill, short, bed)[0] - short * perTurn * step[fill]

    def between(values, fill):
        share = (fill - fills[0]) / (fills[-1] - fills[0])
        return values[fills[0]] * (1 - share) + values[fills[-1]] * share

    def minutes(runs):
        return (
            sum(between(start, fill) + turns * perTurn / n * between(step, fill) for n, fill, turns, start in runs) / 60
        )

    def campaign(table):
        with open(ROOT / "findings/power_of_the_mixer" / table) as runs:
            took = [(float(r["speed"]), float(r["fill"]), float(r["turns_total"])) for r in csv.DictReader(runs)]
        return minutes((*run, filled if run[0] == speeds[0] else taken) for run in took)

    campaigns = [campaign(table) for table in ("grid_8mm.runs.csv", "grid_8mm_own_beds.runs.csv")]
    return {
        "grid_8mm_core_minutes": {
            "minutes": minutes((n, fill, turns, filled) for n in speeds for fill in fills),
            "campaign_minutes": sum(campaigns) / len(campaigns),
            "campaigns": campaigns,
            "us_per_step": [1e6 * step[fill] for fill in step],
            "steps_per_turn": perTurn,
            "fill_s": list(filled.values()),
            "take_bed_s": list(taken.values()),
            "diameter": 0.012 if quick else 0.008,
        }
    }


def lammps(folder, quick, pairs):
    """The distribution's LAMMPS with `pair_style granular` of the same ingredients, on a packing without walls."""
    grains = packing.write(folder, 12 if quick else 24)
    ours, theirs = Engine(folder, script="in.packing"), Lammps(folder)
    ratio = [ours.step(50)["run_s"] / theirs.step(50)["run_s"] for _ in range(pairs)]
    contacts, others = ours.step(1)["pair_contacts"], theirs.contacts()
    for engine in (ours, theirs):
        engine.quit()
    return {"over_lammps": dict(spread(ratio), grains=grains, contacts=contacts, lammps_contacts=others)}


def size(folder, quick, pairs):
    """Cost of a grain and step against the number of grains, on the packing without walls."""
    rows = []
    for cells in (8, 17, 37) if quick else (8, 17, 37, 79):  # 10^3, 10^4, 10^5, 10^6 grains
        grains = packing.write(folder, cells)
        engine = Engine(folder, script="in.packing")
        steps = max(2, round((1e5 if quick else 1e6) / grains))
        took = [engine.step(steps) for _ in range(min(pairs, 15))]
        engine.quit()
        rows.append(
            dict(
                spread([1e9 * t["run_s"] / steps / grains for t in took]),
                grains=grains,
                contacts_per_grain=took[-1]["pair_contacts"] / grains,
            )
        )
    return {"ns_per_particle_step_by_grains": rows}


def triangles(folder, quick, pairs):
    """Cost of a step in the mixer slice against the number of triangles of drum and shaft."""
    beds, counts = [], []
    for factor in (1, 4) if quick else (1, 2, 4, 8):
        where = pathlib.Path(folder, f"mesh{factor}")
        where.mkdir()
        bed = make_bed(
            where, (f"drumSegments={24 * factor}", f"shaftSegments={12 * factor}"), turns=0.05, d=0.012, E=1e5
        )
        counts.append(
            sum(p.read_text(errors="replace").count("endfacet") for p in pathlib.Path(where, "mesh").glob("*.stl"))
        )
        beds.append(Engine(where, law=1, **bed, E=1e5))
    times = [[] for _ in beds]
    for _ in range(pairs):
        for engine, took in zip(beds, times):
            took.append(engine.step(100))
    for engine in beds:
        engine.quit()
    return {
        "us_per_step_by_triangles": [
            dict(
                spread([1e6 * t["run_s"] / t["steps"] for t in took]),
                triangles=count,
                grains=took[-1]["grains"],
                wall_share=statistics.median(t["wall_s"] / t["run_s"] for t in took),
            )
            for took, count in zip(times, counts)
        ]
    }


def memory(folder, quick, pairs):
    """The law's time over the time that the bytes it must move would take at the bandwidth of a triad."""
    grains = packing.write(folder, 30 if quick else 60)
    engine = Engine(folder, script="in.packing")
    ratio, bandwidth = [], []
    for _ in range(min(pairs, 30)):
        triad = json.loads(subprocess.run([BIN / "vielto_triad"], check=True, capture_output=True, text=True).stdout)
        bandwidth.append(triad["bytes_per_s"])
        t = engine.step(5)
        bound = (t["pair_contacts"] * CONTACT_BYTES + grains * GRAIN_BYTES) / bandwidth[-1]
        ratio.append(t["pair_s"] / t["steps"] / bound)
    engine.quit()
    return {
        "over_memory_bound": dict(
            spread(ratio),
            grains=grains,
            contacts=t["pair_contacts"],
            bytes_per_contact=CONTACT_BYTES + GRAIN_BYTES * grains / t["pair_contacts"],
            triad_bytes_per_s=statistics.median(bandwidth),
        )
    }


PARTS = {part.__name__: part for part in (law, ranks, yade, yade_10k, yade_100k, lammps, size, triangles, memory, grid)}
PACKAGES = {
    "yade": ["yade"],
    "yade_10k": ["yade"],
    "yade_100k": ["yade"],
    "lammps": ["lammps"],
}  # lists in scripts/packages beyond those of every part


def machine():
    model = next(
        (line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown"
    )
    return {"cpu": model, "cores": os.cpu_count()}
