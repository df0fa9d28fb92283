# SPDX-License-Identifier: GPL-2.0-or-later
"""How strongly each effect and each member of the family acts on what is observed, from a response library's own runs.

  scripts/library responses libraries/millet
  scripts/library responses libraries/wheat --observable angle --picture libraries/wheat/responses.svg

What is observed with the effect, the mean over its runs, over the mean of the baseline's seeds under the same conditions,
less 1, in %. Power is loaded less idle. Standard uncertainty: of a run, the greater of the scatter between seeds and the
run's own u; of a mean over n runs, that over the root of n. The scatter is that of the condition, pooled with the others'
where --pool is given. For the calibrated family: mean and standard deviation of its members, the runs' own
scatter taken out, and the band of two of them to either side (95 % of a normal distribution).
The picture (python3-matplotlib) has a panel for each effect, a line for each condition.
--out: the same as a table, with the scatter of a seed and the calibrated family as rows of their own; with --pairs that of the
pairs; with --exponent CONDITION the exponent that each effect adds to a power law in it, between its ends.
--pairs: runs with two effects at once (tests called SOME_EFFECT1_and_EFFECT2_sN), beside what the two make if they multiply.
"""
import math
import pathlib
import re
import tomllib
from collections import defaultdict

from tools import pictures, tables
from tools.errors import BadInput

CONDITIONS = ("speed", "fill", "moisture", "normal_stress", "shear_velocity", "tilt")


def add_options(parser):
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--observable", default="power", help="power, angle, torque_ripple, ...")
    parser.add_argument("--pool", action="store_true", help="one scatter for all conditions")
    parser.add_argument("--out", type=pathlib.Path, metavar="CSV")
    parser.add_argument(
        "--exponent", choices=CONDITIONS, help="of this condition, between its least and its greatest value"
    )
    pictures.add_option(parser)
    parser.add_argument(
        "--pairs", type=pathlib.Path, metavar="TABLE", help="observations of runs with two effects: do they multiply?"
    )


def work(options):
    design = {row["test"]: row for row in read(options.library / "design.csv", ["test", "effect", "strength"])}
    rows = read_observations(options.library / "observations.csv")
    found = observed(rows, options.observable)
    if not found:
        known = sorted({row["observable"] for row in rows})
        raise BadInput(
            f"{options.library}: there is no {options.observable} in it; --observable takes {', '.join(known)}"
        )
    scatter, table, family, centre = responses(design, found, options.pool)
    pairs = []
    if options.pairs:
        of_pairs = {}
        for test, (value, u, at) in observed(read_observations(options.pairs), options.observable).items():
            if at not in centre:
                raise BadInput(f"{options.pairs}: test {test}: the library has no baseline at {text(at)}; run it there")
            of_pairs[test] = value / centre[at], u / centre[at], at
        pairs = interactions(of_pairs, table, scatter)
    if options.picture:
        draw(options.picture, table, options.observable, options.library.resolve().parent / "effects")
    tell(options.observable, scatter, family, table)
    if pairs:
        tell_pairs(pairs)
    trend = exponents(table, options.exponent) if options.exponent else []
    for what, strength, at, value, u in trend:
        print(f"{what} {strength:g} adds {value:+.2f} ± {u:.2f} to the exponent of {options.exponent} at {text(at)}")
    if options.out:
        if options.pairs:
            rows = pair_rows(pairs)
        elif options.exponent:
            rows = [of(what, s, at, exponent=value, u=u) for what, s, at, value, u in trend]
        else:
            rows = response_rows(scatter, family, table)
        write(options.out, rows)


def of(what, strength, at, **values):
    """A row of a table to write: its conditions by their names."""
    conditions = {c: f"{dict(at)[c]:g}" if c in dict(at) else "" for c in CONDITIONS}
    told = {name: f"{value:.4g}" for name, value in values.items()}
    return {"what": what, "strength": strength if strength == "" else f"{strength:g}", **conditions, **told}


def response_rows(scatter, family, table):
    rows = [of("one seed", "", at, response=0, u=sd) for at, sd in sorted(scatter.items())]
    for at, (_, middle, sd) in sorted(family.items()):
        rows.append(
            of("calibrated family", "", at, response=middle, u=sd, low95=middle - 2 * sd, high95=middle + 2 * sd)
        )
    return rows + [of(what, strength, at, response=r, u=u) for what, strength, at, r, u in table if strength]


def pair_rows(pairs):
    return [
        of(pair, "", at, together=change, u=u, product=product, beyond=beyond, beyond_u=u_beyond)
        for pair, at, change, u, product, _, beyond, u_beyond in pairs
    ]


def write(path, rows):
    tables.write(path, list(dict.fromkeys(name for row in rows for name in row)), rows)


def exponents(table, condition):
    """[(what, strength, other conditions, change, u)]: ln((1 + r_high)/(1 + r_low)) / ln(high/low) of each effect that was
    run at the condition's least and greatest value with all else alike; its scatter at both ends is independent."""
    ends = defaultdict(dict)
    for what, strength, at, r, u in table:
        others = tuple((c, v) for c, v in at if c != condition)
        if strength and condition in dict(at):
            ends[what, strength, others][dict(at)[condition]] = r, u
    rows = []
    for (what, strength, others), seen in ends.items():
        low, high = min(seen), max(seen)
        if not 0 < low < high:
            continue
        (r_low, u_low), (r_high, u_high) = seen[low], seen[high]
        over = math.log(high / low)
        change = math.log((1 + r_high) / (1 + r_low)) / over
        rows.append((what, strength, others, change, math.hypot(u_low / (1 + r_low), u_high / (1 + r_high)) / over))
    return rows


def read(path, columns):
    return tables.read(path, columns, "name a response library")


def read_observations(path):
    return read(path, ["test", "observable", "value", "u", *CONDITIONS])


def observed(rows, observable):
    """{test: (value, u, conditions)} of one observable; power also as loaded less idle."""
    seen = defaultdict(dict)
    for row in rows:
        at = tuple((c, row.number(c)) for c in CONDITIONS if row[c])
        seen[row["test"]][row["observable"]] = (row.number("value"), row.number("u"), at)
    found = {}
    for test, of in seen.items():
        if observable == "power" and {"power_loaded", "power_idle"} <= set(of):
            (loaded, u, at), (idle, u_idle, _) = of["power_loaded"], of["power_idle"]
            found[test] = (loaded - idle, math.hypot(u, u_idle), at)
        elif observable in of:
            found[test] = of[observable]
    return found


def mean(values):
    return sum(values) / len(values)


def responses(design, found, pool):
    """(scatter of a seed by condition, [(what, strength, conditions, response, u)], {conditions: (members, mean, sd)}, {conditions: baseline}),
    relative to the baseline."""
    parameters = list(next(iter(design.values())))[5:]
    of = {test: tuple(row[p] for p in parameters) for test, row in design.items()}
    plain = [of[t] for t, row in design.items() if row["effect"] == "none" and t in found]
    own = max(sorted(set(plain)), key=plain.count)
    runs, sets = defaultdict(list), {}
    for test, (value, u, at) in found.items():
        row = design[test]
        what, strength = row["effect"], float(row["strength"])
        if what == "none":
            what = "" if of[test] == own else ", ".join(f"{p} {float(v):.3g}" for p, v in zip(parameters, of[test]))
        runs[what, strength, at].append((value, u))
        sets[at] = None
    baseline = {at: [v for v, _ in runs[("", 0.0, at)]] for at in sets}
    for at, values in baseline.items():
        if len(values) < 2:
            raise BadInput(f"there are not two runs of the baseline at {text(at)}; run the library's campaign on")
    centre = {at: mean(v) for at, v in baseline.items()}
    squares = {at: (sum((x / centre[at] - 1) ** 2 for x in v), len(v) - 1) for at, v in baseline.items()}
    whole = math.sqrt(sum(s for s, _ in squares.values()) / sum(n for _, n in squares.values()))
    scatter = {at: whole if pool else math.sqrt(s / n) for at, (s, n) in squares.items()}
    table, members = [], defaultdict(list)
    for (what, strength, at), values in sorted(runs.items()):
        if not what:
            continue
        ratio = mean([v for v, _ in values]) / centre[at]
        of_run = max(scatter[at] * abs(ratio), mean([u for _, u in values]) / abs(centre[at])) / math.sqrt(len(values))
        if not strength:
            members[at].append((ratio - 1, of_run))
        table.append(
            (what, strength, at, ratio - 1, math.hypot(of_run, ratio * scatter[at] / math.sqrt(len(baseline[at]))))
        )
    family = {}
    for at, seen in members.items():
        if len(seen) > 2:
            middle = mean([r for r, _ in seen])
            spread = sum((r - middle) ** 2 for r, _ in seen) / (len(seen) - 1)
            family[at] = len(seen), middle, math.sqrt(max(0.0, spread - mean([u * u for _, u in seen])))
    return scatter, table, family, centre


PAIR = re.compile(r"[^_]*_([a-z_]+)(-?[0-9.]+)_and_([a-z_]+)(-?[0-9.]+)_s[0-9]+")


def interactions(pairs, table, scatter):
    """[(pair, conditions, together, u, product, beyond, u)] relative to the baseline; pairs {test: (value over the baseline's, u, conditions)}."""
    single = {(what, strength, at): (r, u) for what, strength, at, r, u in table}
    runs = defaultdict(list)
    for test, (ratio, u, at) in sorted(pairs.items()):
        named = PAIR.fullmatch(test)
        if not named:
            raise BadInput(
                f"test {test} does not name a pair; call it SOME_EFFECT1_and_EFFECT2_sN, each effect with its strength"
            )
        a, s, b, t = named.groups()
        for effect, strength in ((a, float(s)), (b, float(t))):
            if (effect, strength, at) not in single:
                raise BadInput(
                    f"test {test}: the library has no run of {effect} {strength:g} at {text(at)}; run it first"
                )
        runs[(a, float(s)), (b, float(t)), at].append((ratio, u))
    rows = []
    for (one, other, at), of in runs.items():
        (ra, ua), (rb, ub) = single[(*one, at)], single[(*other, at)]
        together, product = mean([r for r, _ in of]), (1 + ra) * (1 + rb)
        # the baseline's own scatter is in both responses and in the pair; it is small beside one run's
        u = max(scatter[at] * together, mean([u for _, u in of])) / math.sqrt(len(of))
        beyond = math.hypot(u / together, ua / (1 + ra), ub / (1 + rb))
        rows.append(
            (
                f"{one[0]} {one[1]:g} and {other[0]} {other[1]:g}",
                at,
                together - 1,
                u,
                product - 1,
                ra * rb,
                together / product - 1,
                beyond,
            )
        )
    return rows


def text(at):
    return ", ".join(f"{name} {value:g}" for name, value in at) or "every condition"


def unit(effects, name):
    try:
        return tomllib.loads((effects / f"{name}.toml").read_text())["unit"]
    except (OSError, KeyError, tomllib.TOMLDecodeError):
        return "?"


def draw(path, table, observable, effect_files):
    plt = pictures.pyplot()
    effects = sorted({what for what, strength, *_ in table if strength})
    varies = [c for c in CONDITIONS if len({dict(at).get(c) for *_, at, _, _ in table}) > 1]
    columns = 3
    rows = math.ceil(len(effects) / columns)
    figure, axes = plt.subplots(rows, columns, figsize=(2.6 * columns, 2.3 * rows), squeeze=False)
    places = sorted({at for *_, at, _, _ in table})
    for axis in axes.flat[len(effects) :]:
        axis.set_visible(False)
    for axis, effect in zip(axes.flat, effects):
        axis.axhline(0, color="0.7", linewidth=0.8)
        for k, at in enumerate(places):
            points = sorted(
                [(s, r, u) for what, s, where, r, u in table if what == effect and where == at] + [(0.0, 0.0, 0.0)]
            )
            if len(points) > 1:
                label = ", ".join(f"{c} {dict(at)[c]:g}" for c in varies if c in dict(at))
                axis.errorbar(
                    [p[0] for p in points],
                    [100 * p[1] for p in points],
                    [100 * p[2] for p in points],
                    fmt="o-",
                    capsize=2,
                    markersize=3.5,
                    linewidth=1,
                    color=f"C{k}",
                    label=label,
                )
        axis.set_title(f"{effect.replace('_', ' ')} [{unit(effect_files, effect)}]", fontsize=12)
        axis.tick_params(labelsize=11)
        axis.locator_params(nbins=4)
    handles = {}
    for axis in axes.flat:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=2, fontsize=12, frameon=False)
    figure.suptitle(f"change of {observable.replace('_', ' ')} [%] over the strength", fontsize=13)
    figure.tight_layout(rect=(0, 0.11 * math.ceil(len(handles) / 2) / rows, 1, 1))
    pictures.save(figure, path)


def tell(observable, scatter, family, table):
    for at, sd in sorted(scatter.items()):
        print(f"one seed scatters by {100 * sd:.1f} % at {text(at)}")
    for at, (n, middle, sd) in sorted(family.items()):
        print(
            f"family of the calibration ({n} members): {100 * middle:+.0f} %, "
            f"95 % band {100 * (middle - 2 * sd):+.0f} … {100 * (middle + 2 * sd):+.0f} % at {text(at)}"
        )
    print(f"\n| what | strength | conditions | {observable} over the baseline's less 1 |\n|---|---|---|---|")
    for what, strength, at, change, u in table:
        print(f"| {what} | {strength:g} | {text(at)} | {100 * change:+.0f} ± {100 * u:.0f} % |")


def tell_pairs(pairs):
    # an interaction of a part k of the product of the responses, a standard deviation (diagnosis.toml, interaction)
    chi2 = {k: sum(beyond**2 / (u**2 + (k * both) ** 2) for *_, both, beyond, u in pairs) for k in (0, 0.5)}
    print(
        f"\ndo effects multiply: chi2 of {len(pairs)} pairs {chi2[0]:.1f}, "
        f"{chi2[0.5]:.1f} with an interaction of half the product"
    )
    print("\n| two effects | conditions | together | if they multiply | product of the responses | over that |")
    print("|---|---|---|---|---|---|")
    for pair, at, change, u, product, both, beyond, u_beyond in pairs:
        print(
            f"| {pair} | {text(at)} | {100 * change:+.0f} ± {100 * u:.0f} % | {100 * product:+.0f} % "
            f"| {100 * both:+.1f} % | {100 * beyond:+.0f} ± {100 * u_beyond:.0f} % |"
        )
