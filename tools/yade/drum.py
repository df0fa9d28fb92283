# SPDX-License-Identifier: GPL-2.0-or-later
"""The drum of case.json: its triangles, and grains placed at random in it."""
import math

import numpy


def turned(triangle, angle):
    """About the x axis."""
    c, s = math.cos(angle), math.sin(angle)
    return [(x, c * y - s * z, s * y + c * z) for x, y, z in triangle]


def covering(length, low, high):
    """A triangle (x, height) over the rectangle 0..length times low..high, a tenth wider than needed."""
    w, h = 1.1 * length, 1.1 * (high - low)
    return [(0.5 * length - w, low - 0.1 * h), (0.5 * length + w, low - 0.1 * h), (0.5 * length, low + 2 * h)]


def drum(case):
    d = case["drum"]
    R, L, n = d["radius"], d["length"], d["sides"]
    half = R * math.tan(math.pi / n)
    sides = [turned([(x, t, -R) for x, t in covering(L, -half, half)], 2 * math.pi * i / n) for i in range(n)]
    wide = 4 * R  # an equilateral triangle round the circle would need 3.5 R
    ends = [[(x, -0.9 * wide, -0.55 * wide), (x, 0.9 * wide, -0.55 * wide), (x, 0, 0.95 * wide)] for x in (0.0, L)]
    return sides + ends


def rotor(case):
    """Blades: the tip's edge is straight, the ends lie outside the drum, the point is near the axis."""
    r, L = case["rotor"], case["drum"]["length"]
    blade = [(-0.6 * L, 0.0, r["tip"]), (1.6 * L, 0.0, r["tip"]), (0.5 * L, 0.0, r["root"])]
    return [turned(blade, 2 * math.pi * i / r["blades"]) for i in range(r["blades"])]


def numbers(v):
    return " ".join(f"{q:.12g}" for q in v)


def stl(name, triangles):
    lines = [f"solid {name}"]
    for t in triangles:
        a, b, c = map(numpy.array, t)
        normal = numpy.cross(b - a, c - a)
        normal /= numpy.linalg.norm(normal)
        lines += [
            f"facet normal {numbers(normal)}",
            "outer loop",
            *(f"vertex {numbers(v)}" for v in t),
            "endloop",
            "endfacet",
        ]
    return "\n".join(lines + [f"endsolid {name}"]) + "\n"


def inside(case, places, room):
    """Which places are at least `room` from every side of the drum; a negative room allows an overlap."""
    d = case["drum"]
    angles = 2 * math.pi * numpy.arange(d["sides"]) / d["sides"]
    # outward normals of the sides: (0, 0, -1) turned about x
    outward = places[:, 1:2] * numpy.sin(angles) - places[:, 2:3] * numpy.cos(angles)
    return (places[:, 0] >= room) & (places[:, 0] <= d["length"] - room) & (outward.max(axis=1) <= d["radius"] - room)


def off_blades(case, places, room):
    free = numpy.ones(len(places), bool)
    for i in range(case["rotor"]["blades"]):
        a = 2 * math.pi * i / case["rotor"]["blades"]
        along = -places[:, 1] * math.sin(a) + places[:, 2] * math.cos(a)
        across = places[:, 1] * math.cos(a) + places[:, 2] * math.sin(a)
        free &= (abs(across) >= room) | (along < case["rotor"]["root"] - room) | (along > case["rotor"]["tip"] + room)
    return free


def random_grains(case, seed):
    """Places without overlap, one after another (random sequential addition)."""
    random = numpy.random.default_rng(seed)
    R, room = case["radius"], 1.01 * case["radius"]
    low = [0, -1.05 * case["drum"]["radius"], -1.05 * case["drum"]["radius"]]
    high = [case["drum"]["length"], -low[1], -low[2]]
    grains = numpy.empty((0, 3))
    for _ in range(60):
        tried = random.uniform(low, high, (2000, 3))
        tried = tried[inside(case, tried, room) & off_blades(case, tried, room)]
        for p in tried:
            if len(grains) == case["grains"]:
                return grains
            if not len(grains) or ((grains - p) ** 2).sum(axis=1).min() > (2.01 * R) ** 2:
                grains = numpy.vstack([grains, p])
    return None
