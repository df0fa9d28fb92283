# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture at the head of README and site: grains in the mixer, the torque on its rotor, an answer of the diagnosis.

  scripts/cover results/demo/run answer/diagnosis.json --picture doc/_static/cover.png     answer of the page doc/index.md
  scripts/cover results/demo/run answer/diagnosis.json --tall --picture doc/_static/cover_phone.png

RUN is a run folder of the mixer with `post/grains.png` and `post/power.json` (vielto post --pictures). The torque is that of
paddles, stems and shaft of the slice on the grains; shaded are the turns that `vielto post` averaged. The bars are the
greatest probabilities of diagnosis.json, without those of pairs.
"""
import pathlib
import textwrap

from tools import files, pictures, tables
from tools.errors import BadInput

PARTS = ("paddles_Nm", "stems_Nm", "shaft_Nm")
BARS = 5


def add_options(parser):
    parser.add_argument("run", type=pathlib.Path, metavar="RUN")
    parser.add_argument("diagnosis", type=pathlib.Path, metavar="DIAGNOSIS.json")
    parser.add_argument("--tall", action="store_true", help="one below another, for a phone")
    pictures.add_option(parser)


def work(options):
    if not options.picture:
        raise BadInput("state --picture FILE")
    grains = options.run / "post/grains.png"
    if not grains.exists():
        raise BadInput(f"{grains}: is not there; vielto post {options.run} --pictures makes it")
    turns, torque = read_torque(options.run / "torque.csv")
    power = files.read_json(options.run / "post/power.json", f"vielto post {options.run} makes it")
    answer = files.read_json(options.diagnosis, "take the answer of vielto gap diagnose")
    if not answer.get("probabilities") or "sentence" not in answer:
        raise BadInput(
            f"{options.diagnosis}: has no sentence and probabilities; take the answer of vielto gap diagnose"
        )
    draw(options.picture, options.tall, grains, turns, torque, power, answer)


def read_torque(path):
    """Turns and the rotor's torque on the grains, N m."""
    _, rows = tables.read_record(path)
    try:
        return [row.number("turn") for row in rows], [sum(row.number(part) for part in PARTS) for row in rows]
    except KeyError as fault:
        raise BadInput(f"{path}: has no column {fault}; take the torque record of a mixer run")


def greatest(probabilities):
    """The `BARS` greatest but for pairs of effects, the greatest last, as a bar chart has them from below."""
    single = {name: p for name, p in probabilities.items() if "+" not in name}
    return sorted(single.items(), key=lambda item: item[1])[-BARS:]


def scene(pyplot, path):
    """The grains alone: without the picture's own words on top, its scale on the right, and white margins."""
    pixels = pyplot.imread(path)[:, :, :3]
    height, width, _ = pixels.shape
    pixels = pixels[round(0.11 * height) :, : round(0.82 * width)]
    drawn = (pixels < 0.99).any(axis=2)
    down, across = drawn.any(axis=1).nonzero()[0], drawn.any(axis=0).nonzero()[0]
    return pixels[down[0] : down[-1] + 1, across[0] : across[-1] + 1]


def panels(pyplot, tall):
    """The figure with its axes for grains, record and causes, the size of its words, and how many letters a line takes."""
    if tall:
        figure = pyplot.figure(figsize=(5, 9), layout="constrained")
        grid = figure.add_gridspec(3, 1, height_ratios=(1.7, 1, 1))
        return figure, [figure.add_subplot(grid[k]) for k in range(3)], 14, 32
    figure = pyplot.figure(figsize=(11, 4.2), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1, 1.1))
    return (
        figure,
        [figure.add_subplot(grid[:, 0]), figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])],
        13,
        60,
    )


def draw(path, tall, grains, turns, torque, power, answer):
    pyplot = pictures.pyplot()
    figure, (left, record, causes), size, letters = panels(pyplot, tall)
    left.imshow(scene(pyplot, grains))
    left.axis("off")
    left.set_title("grains, yellow where they are fast", loc="left", fontsize=size)

    record.axvspan(power["turn_first"], power["turn_first"] + power["turns_averaged"], color="0.92")
    record.plot(turns, torque, linewidth=0.8, color="#1f5fa8")
    record.set_xlim(0, max(turns))
    record.set_ylim(0, 1.1 * max(torque))
    record.set_xlabel("turn", fontsize=size)
    record.set_title("torque on the grains of the slice, N m", loc="left", fontsize=size)

    bars = greatest(answer["probabilities"])
    names = [name.replace("_", " ") for name, _ in bars]
    drawn = causes.barh(names, [100 * p for _, p in bars], color="#1f5fa8", height=0.6)
    causes.bar_label(drawn, fmt="%.0f %%", padding=4, fontsize=size)
    causes.set_xlim(0, 118 * max(p for _, p in bars))
    causes.xaxis.set_visible(False)
    sentence = answer["sentence"].split(":")[0]
    causes.set_title("\n".join(textwrap.wrap(f"“{sentence}”", letters)), loc="left", fontsize=size)
    for axes in (record, causes):
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=size - 1)
    pictures.save(figure, path, dpi=130)
