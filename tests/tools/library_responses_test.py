# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/library responses through its command line, on a library whose responses are known by hand, and on those of the repository."""
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools.library.responses import CONDITIONS  # noqa: E402

# the programs' own list, in its order
stated = re.findall(r'\{"(\w+)", &Observation::', (ROOT / "postproc/core/condition.h").read_text())
assert list(CONDITIONS) == stated, stated


def responses(*words):
    return subprocess.run([ROOT / "scripts/library", "responses", *map(str, words)], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-responses-") as name:
    folder = pathlib.Path(name)
    # baseline 9, 10, 11 (mean 10, scatter 10 %); two runs of an effect 14 and 16; one member 8 with u = 2
    runs = [
        ("a", "none", 0, 1, 20, 9, 0.1),
        ("b", "none", 0, 2, 20, 10, 0.1),
        ("c", "none", 0, 3, 20, 11, 0.1),
        ("d", "shape", 0.2, 1, 20, 14, 0.1),
        ("e", "shape", 0.2, 2, 20, 16, 0.1),
        ("f", "none", 0, 1, 25, 8, 2),
    ]
    (folder / "design.csv").write_text(
        "test,effect,strength,seed,run_hash,frictionAngle\n"
        + "".join(f"{t},{e},{s},{k},{t},{p}\n" for t, e, s, k, p, _, _ in runs)
    )
    (folder / "observations.csv").write_text(
        "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material\n"
        + "".join(
            f"{t},fit,mixer,power_loaded,{v + 3},{u},W,0.5,0.1,,,,,,m\n{t},fit,mixer,power_idle,3,0,W,0.5,0.1,,,,,,m\n"
            for t, _, _, _, _, v, u in runs
        )
    )
    told = responses(folder)
    assert told.returncode == 0, told.stderr
    assert "one seed scatters by 10.0 % at speed 0.5, fill 0.1" in told.stdout, told.stdout
    # mean of two runs +50 %: 1.5 * 10 % / sqrt 2 and 1.5 * 10 % / sqrt 3 together; the member -20 %: its own 20 % and 8 %/sqrt 3
    shape = 100 * math.hypot(0.15 / math.sqrt(2), 0.15 / math.sqrt(3))
    member = 100 * math.hypot(0.2, 0.08 / math.sqrt(3))
    assert f"| shape | 0.2 | speed 0.5, fill 0.1 | +50 ± {shape:.0f} % |" in told.stdout, told.stdout
    assert f"| frictionAngle 25 | 0 | speed 0.5, fill 0.1 | -20 ± {member:.0f} % |" in told.stdout, told.stdout

    # as a table; and a second speed with baseline 20, 20 and one run of the effect 20, +0 % there: the exponent falls by ln 1.5/ln 2
    out = folder / "out.csv"
    assert responses(folder, "--out", out).returncode == 0
    first, *rows = out.read_text().splitlines()
    assert first == "what,strength,speed,fill,moisture,normal_stress,shear_velocity,tilt,response,u", first
    assert rows == ["one seed,,0.5,0.1,,,,,0,0.1", f"shape,0.2,0.5,0.1,,,,,0.5,{shape / 100:.4g}"], rows
    faster = folder / "faster"
    faster.mkdir()
    (faster / "design.csv").write_text(
        (folder / "design.csv").read_text() + "g,none,0,1,g,20\nh,none,0,2,h,20\ni,shape,0.2,1,i,20\n"
    )
    (faster / "observations.csv").write_text(
        (folder / "observations.csv").read_text()
        + "".join(f"{t},fit,mixer,power,20,0.4,W,1,0.1,,,,,,m\n" for t in ("g", "h", "i"))
    )
    told = responses(faster, "--exponent", "speed", "--out", out)
    u = math.hypot(shape / 150, 0.4 / 20) / math.log(2)
    assert told.returncode == 0, told.stderr
    assert (
        out.read_text().splitlines()[1] == f"shape,0.2,,0.1,,,,,{-math.log(1.5) / math.log(2):.4g},{u:.4g}"
    ), out.read_text()

    # the family: members 8, 12, 13 are -20, +20, +30 %: mean +10 %, variance 700, less that of the runs (20, 12, 13 %)
    assert "family" not in told.stdout
    for k, v in ((26, 12), (27, 13)):
        with open(folder / "design.csv", "a") as file:
            file.write(f"m{k},none,0,1,m{k},{k}\n")
        with open(folder / "observations.csv", "a") as file:
            file.write(
                f"m{k},fit,mixer,power_loaded,{v + 3},0.1,W,0.5,0.1,,,,,,m\nm{k},fit,mixer,power_idle,3,0,W,0.5,0.1,,,,,,m\n"
            )
    told = responses(folder)
    sd = math.sqrt(700 - (20**2 + 12**2 + 13**2) / 3)
    assert (
        f"(3 members): +10 %, 95 % band {10 - 2 * sd:+.0f} … {10 + 2 * sd:+.0f} % at speed 0.5, fill 0.1" in told.stdout
    ), told.stdout

    # two effects at once: 24 of 10; shape makes 1.5 and wall_friction 12 of 10: 1.8 if they multiply, a third more together
    with open(folder / "design.csv", "a") as file:
        file.write("w,wall_friction,5,1,w,20\n")
    with open(folder / "observations.csv", "a") as file:
        file.write("w,fit,mixer,power_loaded,15,0.1,W,0.5,0.1,,,,,,m\nw,fit,mixer,power_idle,3,0,W,0.5,0.1,,,,,,m\n")
    header = (folder / "observations.csv").read_text().splitlines()[0]
    pair = folder.parent / (folder.name + ".csv")
    row = "{},fit,mixer,power_loaded,27,0.1,W,{},0.1,,,,,,m\n{},fit,mixer,power_idle,3,0,W,{},0.1,,,,,,m\n"
    name = "pair1_shape0.2_and_wall_friction5_s1"
    pair.write_text(header + "\n" + row.format(name, 0.5, name, 0.5))
    told = responses(folder, "--pairs", pair)
    beyond = 100 * math.hypot(
        0.1, math.hypot(0.1 / math.sqrt(2), 0.1 / math.sqrt(3)), math.hypot(0.1, 0.1 / math.sqrt(3))
    )
    chi2 = 100 / 3 / beyond, 100 / 3 / math.hypot(beyond, 5)
    assert f"chi2 of 1 pairs {chi2[0] ** 2:.1f}, {chi2[1] ** 2:.1f} with" in told.stdout, told.stdout
    assert (
        f"| shape 0.2 and wall_friction 5 | speed 0.5, fill 0.1 | +140 ± 24 % | +80 % | +10.0 % | +33 ± {beyond:.0f} % |"
        in told.stdout
    ), (told.stdout + told.stderr)
    for name, speed, fault in (
        ("two", 0.5, "does not name a pair"),
        ("p_shape0.2_and_cohesion5_s1", 0.5, "has no run of cohesion 5"),
        ("p_shape0.2_and_wall_friction5_s1", 0.7, "has no baseline at speed 0.7"),
    ):
        pair.write_text(header + "\n" + row.format(name, speed, name, speed))
        refused = responses(folder, "--pairs", pair)
        assert (
            refused.returncode == 2
            and fault in refused.stderr
            and refused.stderr.count("\n") == 1
            and not refused.stdout
        ), refused
    pair.unlink()

    for words, fault in (
        ((folder, "--observable", "angle"), "there is no angle in it; --observable takes power_idle, power_loaded"),
        ((folder / "none",), "name a response library"),
    ):
        refused = responses(*words)
        assert refused.returncode == 2 and fault in refused.stderr and refused.stderr.count("\n") == 1, refused
    # a reader that closes at once: no traceback
    end, start = os.pipe()
    os.close(end)
    cut = subprocess.run(
        [ROOT / "scripts/library", "responses", str(folder)], stdout=start, stderr=subprocess.PIPE, text=True
    )
    os.close(start)
    assert cut.stderr == "", cut.stderr
    picture = folder / "p.svg"
    drawn = responses(folder, "--picture", picture)
    if "needs matplotlib" in drawn.stderr:
        assert drawn.returncode == 2 and not picture.exists()
    else:
        assert drawn.returncode == 0 and "<svg" in picture.read_text(), drawn.stderr
    assert not list(folder.glob("*.partial*"))

for library, observable, words in (
    ("millet", "power", "| slice_ends | 1 |"),
    ("wheat", "angle", "| wall_friction | 14 |"),
):
    told = responses(ROOT / "libraries" / library, "--observable", observable)
    assert told.returncode == 0 and words in told.stdout, told.stdout + told.stderr
