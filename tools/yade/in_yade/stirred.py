# SPDX-License-Identifier: GPL-2.0-or-later
"""The stirred drum of yade/stir in Yade, obeying `run N` and `quit` on standard input:

  yade -n -x -j1 stirred_yade.py run.json
"""
import json
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(sys.argv[0]).resolve().parent))
from scene import build  # noqa: E402

run = json.load(open(sys.argv[1]))
build(run)
O.run(1, wait=True)
print("READY", flush=True)
for line in sys.stdin:
    if not line.startswith("run "):
        break
    steps = int(line.split()[1])
    begin = time.perf_counter()
    O.run(steps, wait=True)
    took = time.perf_counter() - begin
    real = [i for i in O.interactions if i.isReal]
    pairs = sum(1 for i in real if max(i.id1, i.id2) < len(run["grains"]))
    print(
        "TIMED",
        json.dumps(
            {
                "steps": steps,
                "run_s": took,
                "grains": len(run["grains"]),
                "pair_contacts": pairs,
                "wall_contacts": len(real) - pairs,
            }
        ),
        flush=True,
    )
