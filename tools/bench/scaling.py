# SPDX-License-Identifier: GPL-2.0-or-later
"""Strong and weak scaling on 1 and 2 ranks, a model fitted to it, and what the full-size drum takes on a cluster.

  bench/scaling [--turns N] [--quick] [--only KIND] [--from FILE] [--out FOLDER]

Strong: the mixer slice with finer and finer grain, on one rank and on two, in turns. Weak: a packing without walls on
one rank, twice of it on two. Both are cut across one axis only, as in.mixer is (`processors * 1 1`).

Model of a step on p ranks, N grains in a length L:   t = c0 + c N/p + h G + (p > 1) l
  c0  what every rank does alone (moving the meshes, bookkeeping)        c  a grain
  G   ghost grains of a rank, 2 (N/L) (d + skin)                        h  one of them: copied, its contacts again
  l   the messages between ranks
All four are fitted to all runs, by least squares of the relative error with none below 0; a periodic case has its ghosts on
one rank too, the drum between its end walls has not. A rank needs a slab of at least 2 (d + skin); beyond that the model
says nothing. It knows no other load on the machine, no network between nodes, no unequal filling.

Writes scaling.json and scaling.png; --from FILE draws and predicts anew from a scaling.json.
"""
import pathlib
import sys
import tempfile

from tools import ROOT, files, pictures
from tools.bench import packing
from tools.bench.parts import machine, spread
from tools.bench.stepping import Engine, build, make_bed
from tools.errors import BadInput

RANKS = (1, 2, 4, 8, 16, 32, 64, 128)
SLICE = 0.765 * 4 / 22  # m, the periodic slice of in.timed
SKIN = 1.25  # d + skin over d
# The full-size drum (cases/mixer/mixer.par, materials/hulled_millet.par): 47.4 dm3, 825 kg/m3 in bulk, grains of 1.8 mm
# and 1375 kg/m3; 87 840 steps a turn at 12 mm, 2 MPa, 1 1/s (doc/reference/cost.md), proportional to 1/d.
DRUM = {
    "length": 0.765,
    "d": 0.0018,
    "grain_mass": 1375 * 3.14159265 / 6 * 0.0018**3,
    "bulk_kg": 0.0474 * 825,
    "steps_per_turn": 87840 * 0.012 / 0.0018,
    "turns": 6,
}


def measure(quick, turns, kinds):
    rows = []

    def add(kind, N, length, d, ranks, seconds):
        rows.append(
            {
                "kind": kind,
                "grains": N,
                "ghosts": 2 * N / length * SKIN * d,
                "ranks": ranks,
                "us_per_step": spread([1e6 * s for s in seconds]),
            }
        )
        print(
            f"{kind}: {N:.0f} grains on {ranks}: {rows[-1]['us_per_step']['median']:.0f} us a step",
            file=sys.stderr,
            flush=True,
        )

    for d in () if "mixer" not in kinds else (0.010, 0.006) if quick else (0.008, 0.006, 0.0045, 0.0035):
        with tempfile.TemporaryDirectory(prefix="vielto-scaling-") as folder:
            bed = dict(make_bed(folder, turns=0.02, d=d, E=1e5), E=1e5)
            one, two = Engine(folder, law=1, **bed), Engine(folder, ranks=2, law=1, **bed)
            steps = 50
            pairs = [(one.step(steps), two.step(steps)) for _ in range(turns)]
            for engine in (one, two):
                engine.quit()
            N = pairs[0][0]["grains"]
            for ranks in (1, 2):
                add("mixer", N, SLICE, d, ranks, [p[ranks - 1]["run_s"] / steps for p in pairs])
    for cells in () if "packing" not in kinds else (8, 16) if quick else (16, 24, 32):
        with tempfile.TemporaryDirectory(prefix="vielto-scaling-") as folder, tempfile.TemporaryDirectory(
            prefix="vielto-scaling-"
        ) as twice:
            N = packing.write(folder, cells)
            packing.write(twice, cells, copies=2)
            engines = {
                (1, 1): Engine(folder, script="in.packing"),
                (2, 1): Engine(folder, ranks=2, script="in.packing"),
                (2, 2): Engine(twice, ranks=2, script="in.packing"),
            }
            took = {key: [] for key in engines}
            for _ in range(turns):
                for key, engine in engines.items():
                    took[key].append(engine.step(20)["run_s"] / 20)
            for (ranks, copies), seconds in took.items():
                engines[ranks, copies].quit()
                edge = 0.995 * packing.D * 2 / 3**0.5 * cells
                add("packing", N * copies, edge * copies, packing.D, ranks, seconds)
    return rows


def fit(rows):
    """c0, c, h, l in microseconds a step."""
    import numpy
    from scipy.optimize import nnls

    t = numpy.array([r["us_per_step"]["median"] for r in rows])
    columns = numpy.array([[1, r["grains"] / r["ranks"], r["ghosts"], r["ranks"] > 1] for r in rows], float)
    c0, c, h, messages = nnls(columns / t[:, None], numpy.ones(len(t)))[0]
    model = {"c0_us": c0, "c_us_per_grain": c, "h_us_per_ghost": h, "l_us": messages}
    model["worst_residual"] = float(
        max(abs(step(model, r["grains"], r["ghosts"], r["ranks"]) / r["us_per_step"]["median"] - 1) for r in rows)
    )
    return model


def step(m, N, ghosts, p):
    return m["c0_us"] + m["c_us_per_grain"] * N / p + m["h_us_per_ghost"] * ghosts + m["l_us"] * (p > 1)


def predict(model):
    """Hours for a run of the full-size drum, at both ends of the fill."""
    answer = []
    for fill in (0.15, 0.25):
        N = fill * DRUM["bulk_kg"] / DRUM["grain_mass"]
        ghosts = 2 * N / DRUM["length"] * SKIN * DRUM["d"]
        # one rank's meshes are those of the slice that was measured, 22/4 of them in the drum
        whole = dict(model, c0_us=model["c0_us"] * 22 / 4)
        for p in RANKS:
            if DRUM["length"] / p < 2 * SKIN * DRUM["d"]:
                continue
            us = step(whole, N, ghosts if p > 1 else 0, p)
            answer.append(
                {
                    "fill": fill,
                    "grains": round(N),
                    "ranks": p,
                    "us_per_step": us,
                    "hours": us * 1e-6 * DRUM["steps_per_turn"] * DRUM["turns"] / 3600,
                    "efficiency": step(whole, N, 0, 1) / p / us,
                }
            )
    return answer


def summary(result):
    lines = [
        f"Made by `bench/scaling` on {result['machine']['cpu']}{' with --quick: a look, not a result' if result['quick'] else ''}.",
        "",
        "| case | grains | ghosts a rank | ranks | µs a step (95 % of the median) | model |",
        "|---|---|---|---|---|---|",
    ]
    for r in result["rows"]:
        u = r["us_per_step"]
        lines.append(
            f"| {r['kind']} | {r['grains']:.0f} | {r['ghosts']:.0f} | {r['ranks']} | {u['median']:.0f} ({u['low']:.0f} to {u['high']:.0f}) "
            f"| {step(result['model'][r['kind']], r['grains'], r['ghosts'], r['ranks']):.0f} |"
        )
    lines += ["", "| | c0, µs | c, µs a grain | h, µs a ghost | l, µs | worst residual |", "|---|---|---|---|---|---|"]
    for kind, m in result["model"].items():
        lines.append(
            f"| {kind} | {m['c0_us']:.0f} | {m['c_us_per_grain']:.3f} | {m['h_us_per_ghost']:.3f} | {m['l_us']:.0f} | {100 * m['worst_residual']:.0f} % |"
        )
    lines += [
        "",
        f"The full-size drum of 1.8 mm grains, {DRUM['turns']} turns of {DRUM['steps_per_turn']:.0f} steps, from the mixer's constants:",
        "",
        "| fill | grains | ranks | ms a step | hours | efficiency |",
        "|---|---|---|---|---|---|",
    ]
    for r in result["full_drum"]:
        lines.append(
            f"| {r['fill']} | {r['grains']} | {r['ranks']} | {1e-3 * r['us_per_step']:.1f} | {r['hours']:.0f} | {100 * r['efficiency']:.0f} % |"
        )
    return "\n".join(lines) + "\n"


def draw(path, result):
    pyplot = pictures.pyplot()
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4.2))
    for kind, colour in (("mixer", "tab:blue"), ("packing", "tab:orange")):
        for ranks, mark in ((1, "o"), (2, "s")):
            rows = sorted(
                (r for r in result["rows"] if r["kind"] == kind and r["ranks"] == ranks), key=lambda r: r["grains"]
            )
            x = [r["grains"] for r in rows]
            left.plot(
                x,
                [r["us_per_step"]["median"] for r in rows],
                mark,
                color=colour,
                label=f"{kind}, {ranks} rank{'s' * (ranks > 1)}",
                mfc=colour if ranks == 1 else "none",
            )
            left.plot(
                x,
                [step(result["model"][kind], r["grains"], r["ghosts"], ranks) for r in rows],
                color=colour,
                lw=0.8,
                ls="-" if ranks == 1 else "--",
            )
    left.set(xscale="log", yscale="log", xlabel="grains", ylabel="µs a step", title="measured, and the model (lines)")
    for fill in (0.15, 0.25):
        rows = [r for r in result["full_drum"] if r["fill"] == fill]
        right.plot(
            [r["ranks"] for r in rows],
            [r["hours"] for r in rows],
            "-",
            label=f"fill {fill}, {rows[0]['grains'] / 1e6:.1f} million grains",
        )
        right.plot([r["ranks"] for r in rows], [rows[0]["hours"] / r["ranks"] for r in rows], ":", color="0.6")
    right.set(
        xscale="log",
        yscale="log",
        xlabel="ranks",
        ylabel="hours for 6 turns",
        title="full-size drum, modelled (dotted: ideal)",
    )
    for axis in (left, right):
        axis.legend(fontsize=8)
    figure.tight_layout()
    pictures.save(figure, path, dpi=90)


def add_options(parser):
    parser.add_argument("--turns", type=int, default=12, help="turns of each engine (default 12)")
    parser.add_argument(
        "--quick", action="store_true", help="small cases and few turns, to build/: a look, not a result"
    )
    parser.add_argument(
        "--only",
        choices=("mixer", "packing"),
        help="measure this anew, take the other's rows from the scaling.json there",
    )
    parser.add_argument(
        "--from",
        dest="source",
        type=pathlib.Path,
        metavar="FILE",
        help="measure nothing: take the rows of this scaling.json",
    )
    parser.add_argument("--out", type=pathlib.Path, metavar="FOLDER")


def work(options):
    out = options.out or ROOT / ("build" if options.quick else "bench")
    if options.turns < 6:
        raise BadInput(f"--turns {options.turns}: an interval of a median needs at least 6")
    if options.source:
        old = read(options.source)
        result = {key: old[key] for key in ("machine", "quick", "rows")}
    else:
        kinds = [options.only] if options.only else ["mixer", "packing"]
        kept = [r for r in read(out / "scaling.json")["rows"] if r["kind"] != options.only] if options.only else []
        build()
        made = measure(options.quick, 8 if options.quick else options.turns, kinds)
        result = {"machine": machine(), "quick": options.quick, "rows": sorted(kept + made, key=lambda r: r["kind"])}
    result["model"] = {kind: fit([r for r in result["rows"] if r["kind"] == kind]) for kind in ("mixer", "packing")}
    result["full_drum"] = predict(result["model"]["mixer"])
    out.mkdir(parents=True, exist_ok=True)
    files.write_json(out / "scaling.json", result)
    draw(out / "scaling.png", result)
    print(summary(result))


def read(path):
    mend = "state a scaling.json of bench/scaling"
    old = files.read_json(path, mend)
    lacking = [key for key in ("machine", "quick", "rows") if key not in old]
    if lacking:
        raise BadInput(f"{path}: has no entry {lacking[0]!r}; {mend}")
    return old
