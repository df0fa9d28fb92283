# SPDX-License-Identifier: GPL-2.0-or-later
"""Both engines of the benchmark start from one bed and step when told: ViElTo and the stock law with LIGGGHTS' own meshes,
integrator and gravity. No time is judged.

  bench_engines_test.py BIN        folder of vielto and vielto_bench
"""
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools.bench import stepping  # noqa: E402

stepping.BIN = pathlib.Path(sys.argv[1])
with tempfile.TemporaryDirectory(prefix="vielto-bench-") as folder:
    bed = stepping.make_bed(folder, d=0.016, turns=0.02)
    grains = set()
    for law in (1, 0):
        engine = stepping.Engine(folder, program=stepping.BIN / "vielto_bench", law=law, **bed)
        told = engine.step(10)
        engine.quit()
        assert told["steps"] == 10 and told["pair_contacts"] > 0 and told["wall_contacts"] > 0, (law, told)
        grains.add(told["grains"])
    assert len(grains) == 1, grains
