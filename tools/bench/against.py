# SPDX-License-Identifier: GPL-2.0-or-later
"""A step of the mixer slice at 8 mm against that of another version of this package, on one machine.

  git worktree add ../before COMMIT && (cd ../before && scripts/build release vielto_bench)
  bench/against ../before [--pairs N] [--fill F]...

Both start from the same bed and take turns, some steps of one, some of the other; the time is the processor's. The
median over the turns of our time over the other's, with its 95 % interval, goes to `step_over_before` in
bench/results.json.
"""
import pathlib
import statistics
import subprocess
import tempfile

from tools import ROOT, files
from tools.bench.parts import spread
from tools.bench.stepping import Engine, build, make_bed
from tools.errors import BadInput

STEPS = 300


def add_options(parser):
    parser.add_argument("other", type=pathlib.Path, metavar="FOLDER", help="the other version's checkout, built")
    parser.add_argument("--pairs", type=int, default=30, help="turns of each (default 30)")
    parser.add_argument("--fill", type=float, action="append", help="drum loading factor; default 0.10 and 0.25")
    parser.add_argument("--out", type=pathlib.Path, metavar="FILE", default=ROOT / "bench/results.json")


def microseconds(engine):
    before = engine.processor_s()
    engine.step(STEPS)
    return 1e6 * (engine.processor_s() - before) / STEPS


def work(options):
    program = options.other / "build/bin/vielto_bench"
    if not program.exists():
        raise BadInput(f"{program} is missing; run scripts/build release vielto_bench in {options.other}")
    if options.pairs < 6:
        raise BadInput(f"--pairs {options.pairs}: an interval of a median needs at least 6")
    results = files.read_json(options.out, "remove it") if options.out.exists() else {}
    told = subprocess.run(["git", "-C", options.other, "describe", "--always"], capture_output=True, text=True)
    build()
    rows = []
    for fill in options.fill or (0.10, 0.25):
        with tempfile.TemporaryDirectory(prefix="vielto-bench-") as folder:
            bed = dict(make_bed(folder, d=0.008, fillFraction=fill), fillFraction=fill, law=1)
            ours, other = Engine(folder, **bed), Engine(folder, program=program.resolve(), **bed)
            times = [(microseconds(ours), microseconds(other)) for _ in range(options.pairs)]
            for engine in (ours, other):
                engine.quit()
        s = spread([a / b for a, b in times])
        a, b = (statistics.median(column) for column in zip(*times))
        rows.append({"fill": fill, **s, "us": a, "before_us": b, "before": told.stdout.strip(), "pairs": options.pairs})
        print(
            f"fill {fill:g}: {a:.0f} us a step, the other {b:.0f}; {s['median']:.3f} [{s['low']:.3f}, {s['high']:.3f}]",
            flush=True,
        )
    files.write_json(options.out, dict(results, step_over_before=rows))
