# SPDX-License-Identifier: GPL-2.0-or-later
"""ViElTo against its peers and against the hardware, all in one report.

  bench/run [--part NAME]... [--pairs N] [--quick] [--out FILE]

law         ViElTo over the stock law with the same ingredients: the law (pair loop and walls) and the whole step
ranks       two ranks over one; bytes a grain
yade        particle-steps a second over Yade's, the stirred drum of yade/stir
yade_10k    the same drum 17 times as long, 10 200 grains
yade_100k   170 times as long, 102 000 grains
lammps      a step over the distribution's LAMMPS with the same ingredients, a packing without walls
size        cost of a grain and step against the number of grains
triangles   cost of a step against the number of triangles
grid        core minutes of the mixer's 4 x 4 grid of speeds and fills at 8 mm
memory      the law over the time that the bytes it must move take at the bandwidth of a triad

Engines that are compared start from the same grains and take turns, some steps of one, some steps of the other, many
times, so that both meet the same weather on the machine; ViElTo and the stock law are compiled into one program with
the same flags. A number is the median over the turns, low and high are the 95 % interval of that median (order
statistics). Writes bench/results.json; a part that is run alone replaces its own
numbers there. --quick is a look: small cases, few turns, and build/bench_quick.json.
"""
import json
import pathlib
import tempfile

from tools import ROOT, files
from tools.bench.parts import PACKAGES, PARTS, machine
from tools.bench.stepping import build
from tools.errors import BadInput
from tools.progress import Progress


def add_options(parser):
    parser.add_argument(
        "--part", action="append", choices=PARTS, metavar="NAME", help="this part only; may be repeated"
    )
    parser.add_argument("--pairs", type=int, default=100, help="turns of each engine (default 100)")
    parser.add_argument("--quick", action="store_true", help="small cases and few turns: a look, not a result")
    parser.add_argument("--out", type=pathlib.Path, metavar="FILE")


def work(options):
    if options.pairs < 6:
        raise BadInput(f"--pairs {options.pairs}: an interval of a median needs at least 6")
    out = options.out or (ROOT / "build/bench_quick.json" if options.quick else ROOT / "bench/results.json")
    results = files.read_json(out, "remove it") if out.exists() else {}
    parts = options.part or list(PARTS)
    build(name for part in parts for name in PACKAGES.get(part, []))
    pairs = min(options.pairs, 12) if options.quick else options.pairs
    progress = Progress("parts measured", len(parts), every=0)
    for part in parts:
        with tempfile.TemporaryDirectory(prefix="vielto-bench-") as folder:
            load = float(open("/proc/loadavg").read().split()[0])
            found = PARTS[part](folder, options.quick, pairs)
        results.update(found)
        results["machine"] = machine()
        results.setdefault("parts", {})[part] = {"pairs": pairs, "quick": options.quick, "load_before": load}
        # after each part: what is measured is not lost if a later one fails
        files.write_json(out, results)
        print(json.dumps(found, indent=2), flush=True)
        progress.step()
