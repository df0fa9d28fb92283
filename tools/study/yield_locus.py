# SPDX-License-Identifier: GPL-2.0-or-later
"""Internal friction angle and bulk cohesion from shear tests under several normal stresses.

  scripts/study yield-locus findings/yield_locus/normal_stress.runs.csv [--peak] [--nominal] [--picture locus.png]

The straight line tau = c + sigma tan(phi) (Mohr-Coulomb) through shear stress and normal stress of each run, by least
squares with the runs' own u; where the runs scatter more than their u says, u of the result is widened by
sqrt(chi^2/(n - 2)). Normal stress is that on the shear plane, where the bed's drag on the upper half adds to the load;
--nominal takes the load plate's. --peak takes the peak of the shear stress instead of the steady part. k = 1.
"""
import math
import pathlib

from tools import pictures, straight_line, tables
from tools.errors import BadInput


def add_options(parser):
    parser.add_argument("runs", type=pathlib.Path)
    parser.add_argument("--peak", action="store_true", help="the peak of the shear stress")
    parser.add_argument(
        "--nominal", action="store_true", help="the load plate's stress instead of that on the shear plane"
    )
    pictures.add_option(parser)


def work(options):
    points = read(options.runs, options.peak, options.nominal)
    c, slope, (aa, _, bb), chi2 = straight_line.fit(points)
    wider = math.sqrt(max(1.0, chi2))
    u_c, u_slope = wider * math.sqrt(aa), wider * math.sqrt(bb)
    angle, u_angle = math.degrees(math.atan(slope)), math.degrees(u_slope / (1 + slope**2))
    if options.picture:
        title = f"internal friction {angle:.1f} ± {u_angle:.1f} deg, cohesion {c:.0f} ± {u_c:.0f} Pa"
        draw(options.picture, points, c, slope, title)
    low, high = min(p[0] for p in points), max(p[0] for p in points)
    print(f"runs                    {len(points)}, normal stress {low:.0f} to {high:.0f} Pa")
    print(f"internal friction angle {angle:.2f} ± {u_angle:.2f} deg")
    print(f"bulk cohesion           {c:.0f} ± {u_c:.0f} Pa")
    print(f"chi^2 / (n - 2)         {chi2:.2f}" + ("; u widened by its root" if chi2 > 1 else ""))


def read(path, peak, nominal):
    """[(normal stress, shear stress, u)], Pa"""
    normal = "normal_stress_Pa" if nominal else "plane_normal_stress_Pa"
    shear = f"shear_stress_{'peak' if peak else 'steady'}"
    columns = [normal, f"{shear}_Pa", f"{shear}_u_Pa"]
    rows = tables.read(path, ["run", *columns], "take runs.csv of a campaign of shear runs", key="run")
    points = [
        (row.number(columns[0]), row.number(columns[1]), row.number(columns[2], above=0))
        for row in rows
        if row.get("rig") in (None, "shearbox")
    ]
    if len(points) < 3 or max(p[0] for p in points) < 1.2 * min(p[0] for p in points):
        raise BadInput(
            f"{path}: {len(points)} shear runs whose normal stresses are not apart; three or more under at least two "
            "loads are needed"
        )
    return points


def draw(path, points, c, slope, title):
    plt = pictures.pyplot()
    figure, axis = plt.subplots(figsize=(6.4, 4.4))
    x, y, u = ([p[k] / 1e3 for p in points] for k in range(3))
    axis.errorbar(x, y, u, fmt="o", capsize=3)
    end = 1.1 * max(x)
    axis.plot([0, end], [c / 1e3, c / 1e3 + slope * end])
    axis.set_xlim(0, None)
    axis.set_ylim(min(0, c / 1e3), None)
    axis.set_xlabel("normal stress [kPa]")
    axis.set_ylabel("shear stress [kPa]")
    axis.set_title(title, fontsize=10)
    figure.tight_layout()
    pictures.save(figure, path)
