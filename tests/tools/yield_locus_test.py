# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/study yield-locus through its command line: a line known by hand, its uncertainty by the closed form, bad tables."""
import math
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEAD = "run,rig,normal_stress_Pa,plane_normal_stress_Pa,shear_stress_steady_Pa,shear_stress_steady_u_Pa,shear_stress_peak_Pa,shear_stress_peak_u_Pa\n"


def locus(*words):
    return subprocess.run([ROOT / "scripts/study", "yield-locus", *map(str, words)], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-locus-") as name:
    table = pathlib.Path(name) / "runs.csv"
    # tau = 200 Pa + 0.6 sigma on the plane, 100 Pa + 0.8 sigma nominal at the peak
    loads = (10000, 20000, 40000)
    rows = [f"p{s},shearbox,{s},{1.1 * s},{200 + 0.66 * s},100,{100 + 0.8 * s},50\n" for s in loads]
    table.write_text(HEAD + "".join(rows) + "heap,repose,,,,,,\n")
    told = locus(table)
    assert told.returncode == 0, told.stderr
    # equal u: u_slope = u/sqrt(sum (x - mean)^2), u_c = u_slope sqrt(mean of x^2)
    x = [1.1 * s for s in loads]
    u_slope = 100 / math.sqrt(sum((a - sum(x) / 3) ** 2 for a in x))
    u_c = u_slope * math.sqrt(sum(a * a for a in x) / 3)
    u_angle = math.degrees(u_slope / (1 + 0.6**2))
    assert f"{math.degrees(math.atan(0.6)):.2f} ± {u_angle:.2f} deg" in told.stdout, told.stdout
    assert f"200 ± {u_c:.0f} Pa" in told.stdout, told.stdout
    told = locus(table, "--peak", "--nominal")
    assert f"{math.degrees(math.atan(0.8)):.2f} ±" in told.stdout and "100 ±" in told.stdout, told.stdout

    # runs that scatter by more than their u widen it: residuals of +-300 Pa about the line at one load
    table.write_text(
        HEAD
        + "".join(
            f"q{k},shearbox,{s},{s},{200 + 0.6 * s + e},100,0,1\n"
            for k, (s, e) in enumerate(((10000, 300), (10000, -300), (40000, 300), (40000, -300)))
        )
    )
    told = locus(table)
    u_slope = 100 / math.sqrt(4 * 15000**2) * math.sqrt(4 * 9 / 2)
    assert "chi^2 / (n - 2)         18.00; u widened" in told.stdout, told.stdout
    assert f"± {math.degrees(u_slope / 1.36):.2f} deg" in told.stdout, told.stdout

    for text, fault in (
        (HEAD + rows[0] + rows[1], "2 shear runs whose normal stresses are not apart"),
        (HEAD + "".join(rows[0].replace("p", str(k), 1) for k in range(3)), "not apart"),
        (HEAD + 3 * rows[0], ":3: p10000 is there twice"),
        (HEAD + rows[0].replace(",100,", ",x,"), ":2: shear_stress_steady_u_Pa is 'x'"),
        (HEAD + rows[0].replace(",11000.0,", ",inf,"), ":2: plane_normal_stress_Pa is 'inf'"),
        (HEAD + rows[0].replace(",100,", ",0,"), "a finite number above 0"),
    ):
        table.write_text(text)
        bad = locus(table)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
    bad = locus(pathlib.Path(name) / "none.csv")
    assert bad.returncode == 2 and "No such file" in bad.stderr, bad
