# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/study size-effect through its command line: a line known by hand, its uncertainty by the closed form, bad tables."""
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools.study import size_effect  # noqa: E402


def effect(table, *words):
    return subprocess.run(
        [ROOT / "scripts/study", "size-effect", table, "--column", "angle_deg", *words], capture_output=True, text=True
    )


for column, words in (("power_W", "power [W]"), ("angle_deg", "angle [deg]"), ("plane_friction_coefficient", None)):
    assert size_effect.label(column) == (words or "plane friction coefficient"), column

with tempfile.TemporaryDirectory(prefix="vielto-size-") as name:
    table = pathlib.Path(name) / "runs.csv"
    # 20 deg + 2500 deg/m d, seeds 0.5 deg to either side at each of two sizes
    rows = [
        f"r{k},{d},{20 + 2500 * d + e}\n"
        for k, (d, e) in enumerate(((0.002, 0.5), (0.002, -0.5), (0.004, 0.5), (0.004, -0.5)))
    ]
    table.write_text("run,grainDiameter,angle_deg\n" + "".join(rows))
    told = effect(table, "--real", "0.001", "--coarse", "0.004")
    assert told.returncode == 0, told.stderr
    # scatter sqrt(4 * 0.25 / 2); u_slope = scatter/sqrt(4 * 0.001^2)
    scatter = math.sqrt(0.5)
    u_slope = scatter / 0.002
    assert f"coarse less real: 7.5 ± {0.003 * u_slope:.2g}" in told.stdout, told.stdout
    # ratio 30/22.5; u of both ends and their covariance about the mean size: value a + b(d - 0.003), a and b independent
    ratio, u_a = 30 / 22.5, scatter / 2
    u = math.hypot((1 - ratio) / 22.5 * u_a, (0.001 + ratio * 0.002) / 22.5 * u_slope)
    assert f"coarse over real: 1.333 ± {u:.2g}" in told.stdout, told.stdout
    assert "line at the real size, 1 mm, extrapolated: 22.5" in told.stdout, told.stdout
    assert "line at the coarse size, 4 mm: 30" in told.stdout, told.stdout
    assert "4 mm: 30 ± 0.5 (2 runs)" in told.stdout, told.stdout
    picture = pathlib.Path(name) / "p.svg"
    drawn = effect(table, "--real", "0.001", "--coarse", "0.004", "--picture", picture)
    if "needs matplotlib" in drawn.stderr:
        assert drawn.returncode == 2 and not picture.exists()
    else:
        assert drawn.stdout == told.stdout and "<svg" in picture.read_text(), drawn.stderr
    assert not list(pathlib.Path(name).glob("*.partial*"))
    # runs of another kind are left out by name
    table.write_text("run,grainDiameter,angle_deg\n" + "".join(rows) + "other,0.004,90\n")
    assert effect(table, "--real", "0.001", "--coarse", "0.004", "--names", "r").stdout == told.stdout
    assert effect(table, "--real", "0.001", "--coarse", "0.004").stdout != told.stdout

    for text, fault in (
        ("run,grainDiameter,angle_deg\n" + "".join(rows[:2]), "three points or more, at two x or more"),
        ("run,grainDiameter\nr,0.002\n", ":1: has no column angle_deg"),
        ("run,grainDiameter,angle_deg\nr,0.002,x\n", ":2: angle_deg is 'x'"),
        ("run,grainDiameter,angle_deg\nr,0.002,nan\n", ":2: angle_deg is 'nan'"),
        ("run,grainDiameter,angle_deg\nr,0,30\n", ":2: grainDiameter is '0'; a finite number above 0"),
        ("run,grainDiameter,angle_deg\n" + 2 * rows[0], ":3: r"),
        ("run,grainDiameter,angle_deg\n", "holds no row"),
        ("", "has no column"),
        ("run,grainDiameter,angle_deg\nr,0.002\n", ":2: has not as many cells"),
        (
            "run,slicePaddles,grainDiameter,schema,angle_deg\na,4,0.004,1,30\nb,2,0.002,1,40\n",
            ":3: b has slicePaddles '2', a '4'; choose runs",
        ),
    ):
        table.write_text(text)
        bad = effect(table, "--real", "0.001", "--coarse", "0.004")
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
    table.write_bytes(bytes(range(256)))
    bad = effect(table, "--real", "0.001", "--coarse", "0.004")
    assert bad.returncode == 2 and "is no CSV table" in bad.stderr and bad.stderr.count("\n") == 1, bad
    table.write_text("run,grainDiameter,angle_deg\n" + "".join(rows))
    for words, fault in (
        (("--real", "-1"), "--real -1: is no grain diameter"),
        (("--real", "nan"), "--real nan"),
        (("--real", "0.001", "--names", "("), "is no regular expression"),
        (("--real", "0.001", "--picture", pathlib.Path(name) / "x.foo"), "a picture is .svg or .png"),
        (("--real", "0.001", "--picture", pathlib.Path(name) / "none/x.png"), "cannot be written"),
    ):
        bad = effect(table, "--coarse", "0.004", *words)
        assert (
            bad.returncode == 2
            and (fault in bad.stderr or "needs matplotlib" in bad.stderr)
            and bad.stderr.count("\n") == 1
        ), bad
    bad = effect(pathlib.Path(name) / "none.csv", "--real", "0.001", "--coarse", "0.004")
    assert bad.returncode == 2 and "No such file" in bad.stderr, bad
