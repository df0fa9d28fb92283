# SPDX-License-Identifier: GPL-2.0-or-later
"""Torque and bed of every run over the turn, both engines over each other."""
import numpy

from tools import pictures

COLOURS = {"liggghts": "tab:blue", "yade": "tab:orange"}


def draw(path, case, answer):
    pyplot = pictures.pyplot()
    panels = {
        "torque, N m": lambda r: r[:, 1],
        "angle of the centre of mass, °": lambda r: numpy.degrees(numpy.arctan2(r[:, 2], -r[:, 3])),
        "distance of the centre of mass, mm": lambda r: 1e3 * numpy.hypot(r[:, 2], r[:, 3]),
    }
    figure, axes = pyplot.subplots(len(panels), 1, figsize=(9, 8), sharex=True)
    for axis, (words, value) in zip(axes, panels.items()):
        for engine, runs in answer.items():
            for rows in runs:
                axis.plot(rows[:, 0], value(rows), color=COLOURS[engine], lw=0.4, alpha=0.4)
            axis.plot(
                runs[0][:, 0],
                numpy.mean([value(rows) for rows in runs], axis=0),
                color=COLOURS[engine],
                lw=1.6,
                label=f"{engine}, mean of {len(runs)} beds",
            )
        axis.axvspan(0, case["averagedFrom"], color="0.92")
        axis.set_ylabel(words)
    axes[0].legend(fontsize=8)
    axes[-1].set_xlabel("turn (grey: not averaged)")
    figure.tight_layout()
    pictures.save(figure, path, dpi=90)
    pyplot.close(figure)
