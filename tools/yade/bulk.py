# SPDX-License-Identifier: GPL-2.0-or-later
"""In bulk: the same stirred drum in liggghts and in Yade, from the same beds, the case of yade/stir/case.json.

For each seed grains are placed at random, come to rest in liggghts, and both engines start from that bed, the grains at
rest. Each run is kept in OUT/bulk/SEED.ENGINE.csv and not made again while the case stays as it is, so a broken-off
call goes on and more seeds can be added. Writes bulk.csv (a line a run), bulk_differences.csv (Yade less liggghts over the
mean of both, 95 % interval) and bulk.png to OUT. Ends with 1 if the 95 % interval of a difference leaves --limit.
"""
import hashlib
import json
import pathlib
import tempfile
import time

from tools import files, tables
from tools.errors import BadInput, RunFailed
from tools.progress import Progress
from tools.yade import DATA
from tools.yade.programs import prepare

ENGINES = ("liggghts", "yade")
COLUMNS = "turn,torque_Nm,y_m,z_m,yy_m2,zz_m2,yz_m2"
NAMES = {
    "torque_Nm": "mean torque",
    "angle_deg": "centre of mass, angle from straight down",
    "distance_m": "centre of mass, distance from the axis",
    "slope_deg": "slope of the bed (long axis of the grains' scatter)",
}


def add_options(parser):
    parser.add_argument("--seeds", type=int, default=5, metavar="N", help="seeds 1 to N (default 5)")
    parser.add_argument("--case", type=pathlib.Path, default=DATA / "stir/case.json", metavar="FILE")
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=NUMBER",
        help="another number of the case, such as grains=200",
    )
    parser.add_argument("--out", type=pathlib.Path, default=DATA / "results", metavar="FOLDER")
    parser.add_argument("--limit", type=float, default=0.05, metavar="PART", help="of the mean of both (default 0.05)")
    parser.add_argument(
        "--liggghts", metavar="PROGRAM", help="liggghts with our laws (default: build/bin/liggghts, built anew)"
    )
    parser.add_argument("--yade", default="yade", metavar="PROGRAM")


def read_case(opts):
    case = files.read_json(opts.case, "give a case with --case")
    wanted = (
        "material",
        "density",
        "radius",
        "grains",
        "drum",
        "rotor",
        "speed",
        "turns",
        "averagedFrom",
        "rowsPerTurn",
        "stepsPerRow",
        "settleTime",
        "gravity",
    )
    for setting in opts.set:
        name, _, value = setting.partition("=")
        if not isinstance(case.get(name), (int, float)):
            raise BadInput(f"--set {setting}: the case has no number {name!r}")
        try:
            case[name] = int(value) if value.isdigit() else float(value)
        except ValueError:
            raise BadInput(f"--set {setting}: {value!r} is no number")
    for name in wanted:
        if name not in case:
            raise BadInput(f"{opts.case}: no entry {name!r}")
        if isinstance(case[name], (int, float)) and name != "averagedFrom" and not case[name] > 0:
            raise BadInput(f"{opts.case}: {name} is {case[name]}; a number above 0 is needed")
    for name in ("grains", "rowsPerTurn", "stepsPerRow"):
        if not isinstance(case[name], int):
            raise BadInput(f"{opts.case}: {name} is {case[name]}; a whole number is needed")
    if case["stepsPerRow"] % 8:
        raise BadInput(
            f"{opts.case}: stepsPerRow is {case['stepsPerRow']}; a multiple of 8 is needed (torque is sampled every 8)"
        )
    if not 0 <= case["averagedFrom"] < case["turns"]:
        raise BadInput(
            f"{opts.case}: averagedFrom is {case['averagedFrom']} of {case['turns']} turns; nothing would be averaged"
        )
    if opts.seeds < 2:
        raise BadInput(f"--seeds {opts.seeds}: an interval needs at least 2")
    case.pop("about", None)
    return case


def stored(path, stamp):
    """The rows of a run made of this very case, or None."""
    import numpy

    if not path.exists() or path.read_text().split("\n", 1)[0] != stamp:
        return None
    return numpy.loadtxt(path, delimiter=",", skiprows=2)


def run_all(opts, case):
    """{engine: [rows of each seed]}; what is kept of this very case is not made again."""
    stamp = "# case=" + hashlib.sha256(json.dumps(case, sort_keys=True).encode()).hexdigest()[:16]
    kept = opts.out / "bulk"
    kept.mkdir(parents=True, exist_ok=True)
    places = {(seed, e): kept / f"{seed}.{e}.csv" for seed in range(1, opts.seeds + 1) for e in ENGINES}
    rows = {key: stored(path, stamp) for key, path in places.items()}
    waiting = [key for key in places if rows[key] is None]
    progress, beds = Progress("runs made", len(waiting)), {}
    for seed, engine in waiting:
        with tempfile.TemporaryDirectory(prefix="vielto-bulk-") as folder:
            rows[seed, engine] = run(opts, case, pathlib.Path(folder), seed, engine, beds)
        lines = [stamp, COLUMNS] + [",".join(f"{v:.9g}" for v in r) for r in rows[seed, engine]]
        files.write_text(places[seed, engine], "\n".join(lines) + "\n")
        progress.step()
    return {engine: [rows[seed, engine] for seed in range(1, opts.seeds + 1)] for engine in ENGINES}


def run(opts, case, folder, seed, engine, beds):
    """Rows of one run; `beds` remembers the grains at rest of each seed."""
    from tools.yade import drum, runs

    runs.meshes(case, folder)
    if seed not in beds:
        grains = drum.random_grains(case, seed)
        if grains is None:
            raise BadInput(f"{opts.case}: {case['grains']} grains find no place in the drum; take fewer")
        beds[seed] = runs.liggghts(opts.liggghts, case, folder, grains, turning=False)
    begin = time.monotonic()
    if engine == "liggghts":
        rows = runs.liggghts(opts.liggghts, case, folder, beds[seed], turning=True)
    else:
        rows = runs.yade(opts.yade, case, folder, beds[seed])
    print(f"seed {seed}, {engine}: {time.monotonic() - begin:.0f} s", flush=True)
    return rows


def difference(a, b):
    """Yade less liggghts over the mean of both, with its 95 % interval (Welch), from one value a seed."""
    import numpy
    from scipy import stats

    a, b = numpy.array(a), numpy.array(b)
    scale = 0.5 * abs(a.mean() + b.mean())
    va, vb = a.var(ddof=1) / len(a), b.var(ddof=1) / len(b)
    dof = (va + vb) ** 2 / (va**2 / (len(a) - 1) + vb**2 / (len(b) - 1))
    half = stats.t.ppf(0.975, dof) * (va + vb) ** 0.5
    middle = b.mean() - a.mean()
    return [q / scale for q in (middle, middle - half, middle + half)]


def write_tables(opts, case, answer):
    from tools.yade.runs import observables

    values = {e: [observables(case, rows) for rows in answer[e]] for e in ENGINES}
    rows = [[i + 1, e, *(f"{values[e][i][name]:.6g}" for name in NAMES)] for i in range(opts.seeds) for e in ENGINES]
    tables.write(opts.out / "bulk.csv", ["seed", "engine", *NAMES], rows)
    differences, beyond = [], []
    for name, words in NAMES.items():
        a, b = ([v[name] for v in values[e]] for e in ENGINES)
        middle, low, high = difference(a, b)
        differences.append([words, *(f"{x:.4g}" for x in (middle, low, high))])
        print(f"{words}: {100 * middle:+.1f} % ({100 * low:+.1f} to {100 * high:+.1f})")
        if low < -opts.limit or high > opts.limit:
            beyond.append(f"{words.split(',')[0]} {100 * low:+.1f} to {100 * high:+.1f} %")
    tables.write(opts.out / "bulk_differences.csv", ["quantity", "difference", "low95", "high95"], differences)
    return beyond


def work(opts):
    case = read_case(opts)
    opts.liggghts = prepare(opts.liggghts, opts.yade)
    answer = run_all(opts, case)
    beyond = write_tables(opts, case, answer)
    from tools.yade.stir_picture import draw

    draw(opts.out / "bulk.png", case, answer)
    if beyond:
        raise RunFailed(f"not shown to lie within ± {100 * opts.limit:g} %: {'; '.join(beyond)}")
