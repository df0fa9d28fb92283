#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/cover: the torque is the sum of the rotor's parts, pairs of effects are left out, a picture comes of a whole folder;
what is not there is refused in one line and leaves no picture."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools import cover  # noqa: E402


def call(*words):
    return subprocess.run([ROOT / "scripts/cover", *words], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-cover-") as name:
    run, answer, picture = pathlib.Path(name, "run"), pathlib.Path(name, "diagnosis.json"), pathlib.Path(name, "c.png")
    (run / "post").mkdir(parents=True)
    shutil.copy(ROOT / "cases/mixer/demo_grains.png", run / "post/grains.png")
    (run / "post/power.json").write_text(json.dumps({"turn_first": 1, "turns_averaged": 2}))
    (run / "torque.csv").write_text(
        "# rig=mixer\nturn,paddles_Nm,stems_Nm,shaft_Nm,drum_Nm\n1,2,0.5,0.25,9\n2,3,0.5,0.25,9\n3,2,0.5,0,9\n"
    )
    assert cover.read_torque(run / "torque.csv") == ([1, 2, 3], [2.75, 3.75, 2.5])
    probabilities = {"a+b": 0.5, "a": 0.2, "c": 0.15, "unknown": 0.1, "d": 0.03, "no_gap": 0.01, "e": 0.009}
    assert cover.greatest(probabilities) == [("no_gap", 0.01), ("d", 0.03), ("unknown", 0.1), ("c", 0.15), ("a", 0.2)]

    answer.write_text(json.dumps({"sentence": "A gap: a 20 %.", "probabilities": probabilities}))
    done = call(run, answer, "--picture", picture)
    assert done.returncode == 0 and picture.read_bytes()[:4] == b"\x89PNG", done
    picture.unlink()

    answer.write_text(json.dumps({"sentence": "A gap."}))
    for words, what in (
        ((run, answer, "--picture", picture), "has no sentence and probabilities"),
        ((pathlib.Path(name), answer, "--picture", picture), "grains.png: is not there"),
        ((run, answer), "state --picture"),
    ):
        bad = call(*words)
        assert bad.returncode == 2 and what in bad.stderr and bad.stderr.count("\n") == 1, bad
        assert not picture.exists()
