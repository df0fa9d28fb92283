# SPDX-License-Identifier: GPL-2.0-or-later
"""The trajectories of both engines over each other, one panel a case."""
import numpy

from tools import pictures


def draw(path, answer):
    pyplot = pictures.pyplot()
    columns = 4
    rows = -(-len(answer) // columns)
    figure, panels = pyplot.subplots(rows, columns, figsize=(4 * columns, 2.5 * rows), squeeze=False)
    for panel in panels.flat[len(answer) :]:
        panel.axis("off")
    for panel, a in zip(panels.flat, answer):
        time = numpy.linspace(0, 1, len(a["ours"])) * 1e3 * a["case"]["end"]
        radius = a["case"]["spheres"][0]["radius"]
        for axis, colour in zip(range(3), ("tab:red", "tab:green", "tab:blue")):
            for first, factor, width in ((3, 1, 1.5), (6, radius, 0.8)):
                panel.plot(time, a["ours"][:, 0, first + axis] * factor, color=colour, lw=width)
                panel.plot(time[::4], a["theirs"][::4, 0, first + axis] * factor, ".", color=colour, ms=3 * width)
        panel.set_title(f"{a['case']['name']}: {100 * a['worst']:.1g} %", fontsize=8)
        panel.tick_params(labelsize=7)
    figure.supxlabel("time, ms")
    figure.supylabel("velocity (thick) and spin times radius (thin) of sphere 1, m/s: x red, y green, z blue")
    figure.suptitle("liggghts (lines) and Yade (dots); in the titles: the largest difference")
    figure.tight_layout(rect=(0.01, 0, 1, 0.985))
    pictures.save(figure, path, dpi=80)
    pyplot.close(figure)
