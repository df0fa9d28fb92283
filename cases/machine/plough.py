#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes the example machine, plough/*.stl: a drum of 200 mm x 240 mm with four ploughs on a shaft, in mm, as binary STL
that a CAD program would write. Dimensions are ours."""
import math
import os
import struct

RADIUS, LENGTH, CHORDS = 100.0, 240.0, 48  # of the drum, mm
SHAFT, SHAFT_CHORDS = 15.0, 24
TIP, WIDTH, DEPTH, NOSE = 98.0, 50.0, 22.0, 30.0  # a plough: reach, along the axis, radially, ahead
ARM = 8.0


def point(x, r, angle):
    return (x, r * math.cos(angle), r * math.sin(angle))


def cylinder(x0, x1, radius, chords, inward):
    """Closed: mantle and two ends."""
    faces = []
    for i in range(chords):
        a, b = 2 * math.pi * i / chords, 2 * math.pi * (i + 1) / chords
        p, q, r, s = point(x0, radius, a), point(x0, radius, b), point(x1, radius, b), point(x1, radius, a)
        faces += [(p, q, r), (p, r, s), ((x0, 0, 0), q, p), ((x1, 0, 0), s, r)]
    return [f[::-1] for f in faces] if inward else faces


def hull(corners, quads):
    """Closed body of plane faces, each counterclockwise from outside."""
    return [(corners[f[0]], corners[f[i]], corners[f[i + 1]]) for f in quads for i in range(1, len(f) - 1)]


def plough(x, angle):
    """A wedge: its keel lies ahead in the direction of rotation, its back is a plane of WIDTH x DEPTH."""

    def at(along, radial, ahead):
        y, z = radial, ahead
        c, s = math.cos(angle), math.sin(angle)
        return (x + along, y * c - z * s, y * s + z * c)

    low, high, half = TIP - DEPTH, TIP - 5, WIDTH / 2  # corners of the back stay inside the tip's circle
    corners = [
        at(-half, low, 0),
        at(half, low, 0),
        at(half, high, 0),
        at(-half, high, 0),
        at(0, low, NOSE),
        at(0, high, NOSE),
    ]
    body = hull(corners, [(3, 2, 1, 0), (0, 1, 4), (2, 3, 5), (1, 2, 5, 4), (3, 0, 4, 5)])
    a = ARM / 2
    box = [at(i * a, r, j * a + a) for r in (SHAFT / 2, low + 2) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return body, hull(box, [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])


def write(path, faces):
    with open(path, "wb") as out:
        out.write(b"plough.py, lengths in mm".ljust(80) + struct.pack("<I", len(faces)))
        for p, q, r in faces:
            u, v = [[b - a for a, b in zip(p, w)] for w in (q, r)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            length = math.sqrt(sum(k * k for k in n))
            out.write(struct.pack("<12fH", *[k / length for k in n], *p, *q, *r, 0))


if __name__ == "__main__":
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "plough"))
    write("drum.stl", cylinder(0, LENGTH, RADIUS, CHORDS, inward=True))
    write("shaft.stl", cylinder(-20, LENGTH + 20, SHAFT, SHAFT_CHORDS, inward=False))
    blades, arms = [], []
    for k in range(4):
        blade, arm = plough(LENGTH * (2 * k + 1) / 8, k * math.pi / 2)
        blades += blade
        arms += arm
    write("ploughs.stl", blades)
    write("arms.stl", arms)
