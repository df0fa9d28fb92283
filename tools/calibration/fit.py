# SPDX-License-Identifier: GPL-2.0-or-later
"""The posterior of a plan from the runs of its study, and a family of its members.

Emulator   for each measured number a Gaussian process over the unit cube (OpenTURNS: linear trend, squared exponential,
           lengths by maximum likelihood), with the runs' own uncertainties; leave-one-out error as part of its error.
Posterior  prior (uniform on the range, or normal where mean and sd are given) times normal likelihood of the targets with
           u_target and the emulator's error, on 2^14 points of a Sobol sequence.
Identified what the data have narrowed: sd over the prior's sd, of each parameter and along the axes of the posterior.
Family     `members` equally weighted points of the posterior, by systematic resampling.

Writes NAME.posterior.csv (weight, one column a -var) and, beside it, NAME.calibration.json; prints what the latter holds.
"""
import math
import pathlib

from tools import files, tables
from tools.calibration import plans
from tools.calibration.emulator import emulate
from tools.errors import BadInput


def add_options(parser):
    parser.add_argument("plan", type=pathlib.Path)
    parser.add_argument("runs", type=pathlib.Path, help="runs.csv of the design's campaign")
    parser.add_argument("--out", type=plans.writable, required=True, metavar="NAME.posterior.csv")


def work(options):
    import numpy as np

    plan = plans.read(options.plan)
    data = read_runs(plan, options.runs)
    emulators = {key: emulate(*entry) for key, entry in data.items()}
    points = np.array(plans.sobol(len(plan["parameter"]), 2**14))
    log_prior, log_posterior = densities(plan, emulators, points)
    before, weight = normalised(log_prior), normalised(log_posterior)
    effective = 1 / (weight**2).sum()
    if effective < 4 * plan["members"]:
        raise BadInput(
            f"{options.runs}: the posterior lies on {effective:.0f} of {len(points)} points; widen the ranges or the "
            "targets' u"
        )
    prior, posterior = covariance(before, points), covariance(weight, points)
    axes = narrowed(prior, posterior)
    result = {
        "plan": str(plan["path"]),
        "observables": [observable(wanted, data, emulators, points, weight) for wanted in plans.wanted(plan)],
        "effective_points": effective,
        "parameters": [
            dict(quantiles(p, points[:, d], weight), sd_over_prior=float(math.sqrt(posterior[d, d] / prior[d, d])))
            for d, p in enumerate(plan["parameter"])
        ],
        "axes": [
            {"sd_over_prior": sd, "axis": {p["name"]: float(a) for p, a in zip(plan["parameter"], axis)}}
            for sd, axis in axes
        ],
    }
    stem = str(options.out).removesuffix(".posterior.csv")
    tables.write(options.out, *family(plan, points, weight, axes[0][1]))
    files.write_json(stem + ".calibration.json", result)
    print(page(result))


def read_runs(plan, path):
    """(run, column) -> points, values and uncertainties of the runs that are there"""
    columns = {wanted[c] for wanted in plans.wanted(plan) for c in ("column", "u_column")}
    table = tables.read(path, ["run", *sorted(columns)], "take runs.csv of the design's campaign", key="run")
    rows, runs = {row["run"]: row for row in table}, {run["name"]: run for run in plan["run"]}
    least = 2 * len(plan["parameter"]) + 2
    found = {}
    for wanted in plans.wanted(plan):
        units, values, u = [], [], []
        for k, point in enumerate(plans.points(plan), 1):
            row = rows.get(f"{wanted['run']}_{k}")
            if row is None:
                continue
            check_made_at(row, plans.variables(plan, point, runs[wanted["run"]]))
            units.append(point)
            values.append(row.number(wanted["column"]))
            u.append(row.number(wanted["u_column"]))
        if len(values) < least:
            raise BadInput(
                f"{path}: only {len(values)} runs of {wanted['run']}; the emulator needs {least} or more: run the rest"
            )
        found[wanted["run"], wanted["column"]] = (units, values, u)
    return found


def check_made_at(row, variables):
    for name, made in variables.items():
        if name not in row:
            raise row.fault(f"has no column {name}; run the design anew")
        if abs(row.number(name) - made) > 1e-5 * max(1, abs(made)):
            raise row.fault(
                f"run {row['run']} was made with {name} {row[name]}, the plan has {made:.6g}; run the design anew"
            )


def densities(plan, emulators, points):
    """Logarithms of prior and posterior at the points, up to a constant each."""
    import numpy as np

    prior = np.zeros(len(points))
    for d, p in enumerate(plan["parameter"]):
        if "sd" in p:
            prior -= 0.5 * ((np.array([plans.to_value(p, u) for u in points[:, d]]) - p["mean"]) / p["sd"]) ** 2
    prior[[not plans.possible(plan, point) for point in points]] = -1e9
    posterior = prior.copy()
    for target in plan["target"]:
        at, error, _ = emulators[target["run"], target["column"]]
        mean, sd = at(points)
        variance = target["u"] ** 2 + np.maximum(sd, error) ** 2
        posterior += -0.5 * (mean - target["value"]) ** 2 / variance - 0.5 * np.log(variance)
    return prior, posterior


def normalised(log_density):
    import numpy as np

    weight = np.exp(log_density - log_density.max())
    return weight / weight.sum()


def covariance(weight, points):
    away = points - weight @ points
    return away.T @ (weight[:, None] * away)


def narrowed(prior, posterior):
    """[(sd over the prior's, axis)] from the covariances, the axes in units of the prior: what was narrowed, and along what."""
    import numpy as np

    root = np.linalg.inv(np.linalg.cholesky(prior))
    ratio, axes = np.linalg.eigh(root @ posterior @ root.T)
    return [(float(math.sqrt(max(r, 0))), axis) for r, axis in zip(ratio, axes.T)]


def observable(wanted, data, emulators, points, weight):
    import numpy as np

    key = wanted["run"], wanted["column"]
    at, error, lengths = emulators[key]
    mean, _ = at(points)
    _, values, _ = data[key]
    middle = weight @ mean
    return {
        "run": wanted["run"],
        "column": wanted["column"],
        "runs": len(values),
        "runs_mean": float(np.mean(values)),
        "runs_low": min(values),
        "runs_high": max(values),
        "emulator_error": error,
        "lengths": lengths,
        "target": wanted.get("value"),
        "u": wanted.get("u"),
        "source": wanted.get("source"),
        "posterior_mean": float(middle),
        "posterior_sd": float(math.sqrt(weight @ (mean - middle) ** 2)),
    }


def quantiles(parameter, units, weight):
    import numpy as np

    order = np.argsort(units)
    cumulated = np.cumsum(weight[order])

    def quantile(q):
        return plans.to_value(parameter, float(units[order][np.searchsorted(cumulated, q)]))

    return {
        "name": parameter["name"],
        "median": quantile(0.5),
        "low95": quantile(0.025),
        "high95": quantile(0.975),
    }


def family(plan, points, weight, along):
    """Header and rows of the members, by systematic resampling in the order of the axis that was narrowed most."""
    import numpy as np

    n = plan["members"]
    order = np.argsort(points @ along)
    steps = np.searchsorted(np.cumsum(weight[order]), (np.arange(n) + 0.5) / n)
    members = points[order][np.minimum(steps, len(points) - 1)]
    rows = [[f"{1 / n:.6g}", *(f"{v:.6g}" for v in plans.variables(plan, m).values())] for m in members]
    return ["weight", *plan["vars"]], rows


def page(result):
    lines = [
        "# Calibration",
        "",
        f"By `scripts/calibrate fit {result['plan']}`; nothing here knows the mixer's power.",
        "",
        "| measured in | runs | simulated range | emulator's error | target | after calibration |",
        "|---|---|---|---|---|---|",
    ]
    for o in result["observables"]:
        target = "none" if o["target"] is None else f"{o['target']:g} ± {o['u']:g}"
        lines.append(
            f"| {o['run']}: {o['column']} | {o['runs']} | {o['runs_low']:.3g} … {o['runs_high']:.3g} "
            f"| {o['emulator_error']:.2g} | {target} | {o['posterior_mean']:.3g} ± {o['posterior_sd']:.2g} |"
        )
    lines += ["", "| parameter | median | 95 % | sd over the prior's |", "|---|---|---|---|"]
    for p in result["parameters"]:
        lines.append(
            f"| {p['name']} | {p['median']:.3g} | {p['low95']:.3g} … {p['high95']:.3g} | {p['sd_over_prior']:.2f} |"
        )
    lines += ["", "Axes of the posterior, in units of the prior: near 1 the data say nothing along it.", ""]
    for a in result["axes"]:
        lines.append(f"- {a['sd_over_prior']:.2f}: " + ", ".join(f"{v:+.2f} {name}" for name, v in a["axis"].items()))
    sources = [f"- {o['run']}: {o['source']}" for o in result["observables"] if o["source"]]
    return "\n".join([*lines, "", "Sources of the targets:", *sources]) + "\n"
