# SPDX-License-Identifier: GPL-2.0-or-later
"""bench/scaling through its command line: rows made from known constants give those constants, and the drum's hours."""
import json
import pathlib
import subprocess
import tempfile

SCALING = pathlib.Path(__file__).resolve().parents[2] / "bench/scaling"
C0, C, H, L = 40.0, 0.5, 0.2, 25.0


def rows(kind):
    for grains, length in ((1000, 0.14), (4000, 0.14), (20000, 0.14)):
        d = 0.2 / grains ** (1 / 3)
        ghosts = 2 * grains / length * 1.25 * d
        for ranks in (1, 2):
            t = C0 + C * grains / ranks + H * ghosts + L * (ranks > 1)
            yield {
                "kind": kind,
                "grains": grains,
                "ghosts": ghosts,
                "ranks": ranks,
                "us_per_step": {"median": t, "low": t, "high": t},
            }


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "in.json").write_text(
        json.dumps({"machine": {"cpu": "none"}, "quick": True, "rows": [*rows("mixer"), *rows("packing")]})
    )
    subprocess.run([SCALING, "--from", folder / "in.json", "--out", folder], check=True, stdout=subprocess.DEVNULL)
    result = json.loads((folder / "scaling.json").read_text())
    model = result["model"]["mixer"]
    for key, value in (("c0_us", C0), ("c_us_per_grain", C), ("h_us_per_ghost", H), ("l_us", L)):
        assert abs(model[key] / value - 1) < 1e-6, (key, model[key])
    # by hand: l = 0.15 of 47.4 dm3 at 825 kg/m3 in grains of 4.199 mg is 1.397 million; 585 600 steps a turn, 6 turns
    one = next(r for r in result["full_drum"] if r["ranks"] == 1 and r["fill"] == 0.15)
    assert abs(one["grains"] / 1.397e6 - 1) < 1e-3, one
    assert abs(one["hours"] / ((40 * 5.5 + 0.5 * one["grains"]) * 1e-6 * 585600 * 6 / 3600) - 1) < 1e-6, one
    # a slab of 2 * 1.25 * 1.8 mm: 128 ranks over 765 mm leave 6 mm
    assert max(r["ranks"] for r in result["full_drum"]) == 128
    assert all(
        a["hours"] > b["hours"] for a, b in zip(result["full_drum"], result["full_drum"][1:]) if a["fill"] == b["fill"]
    )
    assert (folder / "scaling.png").exists()

    (folder / "in.json").write_text("{")
    refused = subprocess.run([SCALING, "--from", folder / "in.json"], capture_output=True, text=True)
    assert refused.returncode == 2 and "in.json:1: no JSON" in refused.stderr, refused
    assert subprocess.run([SCALING, "--turns", "3"], capture_output=True).returncode == 2
print("scaling: ok")
