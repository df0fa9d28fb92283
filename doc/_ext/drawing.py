# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {rig-drawing} cases/mixer/mixer.par: the rig that the parameter file names, to scale, with the dimensions that
stand in it, in mm. Lines take the colour of the page's text. Dashed surfaces only show which angle is meant."""
import math

from docutils import nodes

from from_code import LINE, FromFile

WIDTH = 900  # of a drawing, in its own units; 1 mm of the mixer
ARROW, GAP = 9, 46


def line(x1, y1, x2, y2, kind="thin"):
    return f'<line class="{kind}" x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}"/>'


def words(x, y, text, turned=False, anchor="middle"):
    turn = f' transform="rotate(-90 {x:.1f} {y:.1f})"' if turned else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{turn}>{text}</text>'


def arrow(x, y, dx, dy):
    """A head at (x, y) that points along (dx, dy)."""
    ax, ay, bx, by = x - ARROW * dx, y - ARROW * dy, 0.35 * ARROW * dy, 0.35 * ARROW * dx
    return f'<path class="head" d="M{x:.2f} {y:.2f} L{ax - bx:.2f} {ay + by:.2f} L{ax + bx:.2f} {ay - by:.2f} Z"/>'


def level(x1, x2, y, edge, text):
    """A dimension from x1 to x2 at height y, with lines to what is measured at height `edge`."""
    return [
        line(x1, edge, x1, y + 6 if y > edge else y - 6),
        line(x2, edge, x2, y + 6 if y > edge else y - 6),
        line(x1, y, x2, y),
        arrow(x1, y, -1, 0),
        arrow(x2, y, 1, 0),
        words((x1 + x2) / 2, y - 7, text),
    ]


def upright(y1, y2, x, edge, text):
    return [
        line(edge, y1, x + 6 if x > edge else x - 6, y1),
        line(edge, y2, x + 6 if x > edge else x - 6, y2),
        line(x, y1, x, y2),
        arrow(x, y1, 0, -1),
        arrow(x, y2, 0, 1),
        words(x - 7, (y1 + y2) / 2, text, turned=True),
    ]


def pointer(x, y, to_x, to_y, text):
    return [line(x, y, to_x, to_y), words(to_x + 6, to_y + 8, text, anchor="start")]


def millimetres(value):
    return f"{1000 * value:g}"


def end_view(p, cx, cy):
    """Along the shaft, its centre at (cx, cy); down is positive."""
    radius, top = 500 * p["drumWidth"], cy - 1000 * p["drumHeight"] + 500 * p["drumWidth"]
    tip, shaft = radius - 1000 * p["clearance"], 500 * p["shaftDiameter"]
    inner = tip - 1000 * p["paddleWidth"]
    out = [
        f'<path class="wall" d="M{cx - radius} {top} V{cy} A{radius} {radius} 0 0 0 {cx + radius} {cy} V{top}"/>',
        f'<circle class="part" cx="{cx}" cy="{cy}" r="{shaft}"/>',
    ]
    for turn in range(4):
        out += [
            f'<g transform="rotate({turn * 90} {cx} {cy})">',
            f'<rect class="part" x="{cx - 1}" y="{cy - inner - 2}" width="2" height="{inner + 2 - shaft}"/>',
            f'<rect class="paddle" x="{cx - 5}" y="{cy - tip}" width="10" height="{tip - inner}"/></g>',
        ]
    out += level(cx - radius, cx + radius, cy + radius + GAP, cy, millimetres(p["drumWidth"]))
    out += upright(top, cy + radius, cx - radius - GAP, cx - radius, millimetres(p["drumHeight"]))
    right = cx + radius + 30
    out += pointer(cx + shaft * 0.7, cy - shaft * 0.7, right, cy - 70, f"shaft Ø{millimetres(p['shaftDiameter'])}")
    out += pointer(cx + (tip + inner) / 2, cy + 3, right, cy, f"lever {millimetres(p['powerLever'])}")
    out += pointer(cx + 0.5 * tip + 4, cy + 0.87 * radius, right, cy + 70, f"clearance {millimetres(p['clearance'])}")
    return out


def side_view(p, x0, cy):
    length, radius = 1000 * p["drumLength"], 500 * p["drumWidth"]
    top, tip, shaft = cy - 1000 * p["drumHeight"] + radius, radius - 1000 * p["clearance"], 500 * p["shaftDiameter"]
    wide, deep, pitch = 1000 * p["paddleLength"], 1000 * p["paddleWidth"], 1000 * p["paddlePitch"]
    count = int(p["paddleCount"])
    first = x0 + (length - (count - 1) * pitch) / 2
    slice_width = length / count * p["slicePaddles"]
    out = [
        f'<rect class="slice" x="{x0 + length / 2 - slice_width / 2:.2f}" y="{top}" width="{slice_width:.2f}" height="{radius + cy - top}"/>',
        f'<path class="wall" d="M{x0} {top} V{cy + radius} H{x0 + length} V{top}"/>',
        f'<rect class="part" x="{x0}" y="{cy - shaft}" width="{length}" height="{2 * shaft}"/>',
    ]
    ahead = []
    for k in range(count):
        x, angle = first + k * pitch, math.radians(k * p["paddleAngleStep"])
        height, towards = math.sin(angle), math.cos(angle)
        if abs(height) < 0.5:  # towards the looker or away: the blade from its narrow side
            tilt = p["paddleInclination"] * (1 if towards > 0 else -1)
            blade = f'<rect class="paddle" x="{x - wide / 2}" y="{cy - 1.5}" width="{wide}" height="3" transform="rotate({-tilt} {x} {cy})"/>'
            (ahead if towards > 0 else out).append(blade)
            continue
        up = -1 if height > 0 else 1
        middle = cy + up * (tip - deep / 2)
        out.append(line(x, cy + up * shaft, x, middle, "stem"))
        out.append(f'<rect class="paddle" x="{x - wide / 2}" y="{middle - deep / 2}" width="{wide}" height="{deep}"/>')
    out += ahead
    out += level(x0, x0 + length, cy + radius + GAP, cy + radius, millimetres(p["drumLength"]))
    middle = x0 + length / 2
    below = cy + radius + 1.9 * GAP
    out += level(
        middle - slice_width / 2,
        middle + slice_width / 2,
        below,
        cy + radius,
        f"{slice_width:.0f}",
    )
    out.append(
        words(middle + slice_width / 2 + 12, below + 8, f"slice of {p['slicePaddles']:.0f} paddles", anchor="start")
    )
    ups = [first + k * pitch for k in range(count) if abs(math.sin(math.radians(k * p["paddleAngleStep"]))) > 0.5]
    out += pointer(
        ups[0] - wide / 4,
        cy - tip + 4,
        x0 + 20,
        top - 14,
        f"{count} paddles {wide:g} × {deep:g}, {p['paddleInclination']:g}° inclined",
    )
    out.append(words(x0 + length, top - 6, f"stems {pitch:g} apart", anchor="end"))
    return out


def mixer(p):
    """Along the shaft and from the side."""
    return end_view(p, 330, 190) + side_view(p, 70, 610), 850


def box(kind, x, y, width, height):
    return f'<rect class="{kind}" x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}"/>'


def path(kind, points, close=""):
    return f'<path class="{kind}" d="M{" L".join(f"{x:.1f} {y:.1f}" for x, y in points)}{close}"/>'


def moves(x1, y1, x2, y2):
    """A thick arrow: something moves or presses."""
    length = math.hypot(x2 - x1, y2 - y1)
    dx, dy = (x2 - x1) / length, (y2 - y1) / length
    return line(x1, y1, x2 - 20 * dx, y2 - 20 * dy, "stem") + path(
        "head",
        [(x2, y2), (x2 - 24 * dx - 9 * dy, y2 - 24 * dy + 9 * dx), (x2 - 24 * dx + 9 * dy, y2 - 24 * dy - 9 * dx)],
        " Z",
    )


def shearbox(p):
    """From the side; the split plane at `split`, down is positive."""
    k = 5000
    length, height, below = k * p["boxLength"], k * p["boxHeight"], k * p["splitHeight"]
    flange, plate = k * p["flangeLength"], k * p["plateThickness"]
    left, split = 210, 250
    right, bed, top, bottom = left + length, split - (height - below), split - (height - below) - 110, split + below
    out = [
        box("bed", left, bed, length, height),
        path("wall", [(left, top), (left, split - 3)]),
        path("wall", [(right, top), (right, split - 3)]),
        path(
            "wall",
            [
                (left - flange, split),
                (left, split),
                (left, bottom),
                (right, bottom),
                (right, split),
                (right + flange, split),
            ],
        ),
        box("part", left + 2, bed - plate, length - 4, plate),
        moves((left + right) / 2, top - 20, (left + right) / 2, bed - plate - 2),
        words((left + right) / 2 + 20, top + 10, f"{1e-3 * p['normalStress']:.1f} kPa", anchor="start"),
        moves(right + 30, bottom - 30, right + 130, bottom - 30),
        words(right + 140, bottom - 22, "lower half moves", anchor="start"),
        words(right + 20, bed - plate + 2, "load plate, free", anchor="start"),
        words(right + flange + 12, split + 8, f"flange {millimetres(p['flangeLength'])}", anchor="start"),
    ]
    out += level(
        left, right, bottom + GAP, bottom, f"{millimetres(p['boxLength'])} (and {millimetres(p['boxWidth'])} deep)"
    )
    out += upright(bed, bottom, left - flange - 60, left, millimetres(p["boxHeight"]))
    out += upright(split, bottom, left - flange - 15, left - flange, millimetres(p["splitHeight"]))
    return out, bottom + GAP + 20


def repose(p):
    """From the side; the heap of the same volume."""
    k, cx, floor = 2600, WIDTH / 2, 330
    radius, height, fill = k * p["cylinderDiameter"] / 2, k * p["cylinderHeight"], k * p["fillHeight"]
    slope = math.radians(35)
    foot = (3 * radius**2 * fill / math.tan(slope)) ** (1 / 3)
    half = k * p["baseWidth"] / 2
    out = [
        box("bed", cx - radius, floor - fill, 2 * radius, fill),
        path("wall", [(cx - half, floor), (cx + half, floor)]),
        path("wall", [(cx - radius, floor), (cx - radius, floor - height)]),
        path("wall", [(cx + radius, floor), (cx + radius, floor - height)]),
        path("dashed", [(cx - foot, floor), (cx, floor - foot * math.tan(slope)), (cx + foot, floor)]),
        words(cx + foot + 12, floor - 10, "angle of repose", anchor="start"),
        moves(cx + radius + 40, floor - height + 90, cx + radius + 40, floor - height),
        words(cx + radius + 60, floor - height + 50, f"lifted at {millimetres(p['liftSpeed'])} mm/s", anchor="start"),
    ]
    out += level(
        cx - radius, cx + radius, floor - height - 20, floor - height, f"Ø{millimetres(p['cylinderDiameter'])}"
    )
    out += upright(floor - height, floor, cx - foot - 90, cx - radius, millimetres(p["cylinderHeight"]))
    out += upright(floor - fill, floor, cx - foot - 30, cx - radius, millimetres(p["fillHeight"]))
    out += level(cx - half, cx + half, floor + GAP, floor, f"base {millimetres(p['baseWidth'])}")
    return out, floor + GAP + 20


def drum(p):
    """Along the axis, half full, and from the side."""
    k, cy = 2000, 190
    radius, length, slope = k * p["drumDiameter"] / 2, k * p["drumLength"], math.radians(35)
    cx, x0 = 290, 620
    ax, ay = radius * math.cos(slope), radius * math.sin(slope)
    out = [
        f'<path class="bed" d="M{cx + ax:.1f} {cy - ay:.1f} A{radius} {radius} 0 0 1 {cx - ax:.1f} {cy + ay:.1f} Z"/>',
        f'<circle class="wall" cx="{cx}" cy="{cy}" r="{radius}"/>',
        line(cx - ax, cy + ay, cx + ax, cy - ay),
        line(cx, cy, cx + radius, cy),
        words(cx + 70, cy - 12, "angle", anchor="start"),
        f'<path class="arc" d="M{cx + 60} {cy} A60 60 0 0 0 {cx + 60 * math.cos(slope):.1f} {cy - 60 * math.sin(slope):.1f}"/>',
        moves(cx - 30, cy - radius + 38, cx - 110, cy - radius + 75),
        words(cx - 45, cy - 50, f"{60 * p['speed']:.3g} rpm"),
        box("bed", x0, cy, length, radius),
        box("wall", x0, cy - radius, length, 2 * radius),
        line(x0 - 40, cy, x0 + length + 40, cy),
        words(x0 + length + 50, cy + 8, "axis, level", anchor="start"),
        words(x0 + length + 50, cy + 38, "or tilted", anchor="start"),
    ]
    out += level(cx - radius, cx + radius, cy + radius + GAP, cy, f"Ø{millimetres(p['drumDiameter'])}")
    out += level(x0, x0 + length, cy + radius + GAP, cy + radius, millimetres(p["drumLength"]))
    return out, cy + radius + GAP + 20


def silo(p):
    """Cut along the axis."""
    k, cx, floor = 1900, WIDTH / 2, 440
    radius, height, fill = k * p["siloDiameter"] / 2, k * p["siloHeight"], k * p["fillHeight"]
    hole, slope = k * p["orificeDiameter"] / 2, math.radians(35)
    rise = (radius - hole) * math.tan(slope)
    out = [
        box("bed", cx - radius, floor - fill, 2 * radius, fill),
        path("wall", [(cx - radius, floor - height), (cx - radius, floor), (cx - hole, floor)]),
        path("wall", [(cx + radius, floor - height), (cx + radius, floor), (cx + hole, floor)]),
        path("dashed", [(cx - hole, floor), (cx - radius, floor - rise)]),
        path("dashed", [(cx + hole, floor), (cx + radius, floor - rise)]),
        moves(cx, floor - 30, cx, floor + 60),
    ]
    out += pointer(cx + radius - 15, floor - rise + 12, cx + radius + 40, floor - rise - 20, "drained angle")
    out += level(cx - radius, cx + radius, floor - height - 20, floor - height, f"Ø{millimetres(p['siloDiameter'])}")
    out += upright(floor - height, floor, cx - radius - 100, cx - radius, millimetres(p["siloHeight"]))
    out += upright(floor - fill, floor, cx - radius - 40, cx - radius, millimetres(p["fillHeight"]))
    out += pointer(cx + hole, floor, cx + radius + 40, floor + 30, f"orifice Ø{millimetres(p['orificeDiameter'])}")
    return out, floor + 75


VIEWS = {"mixer": mixer, "shearbox": shearbox, "repose": repose, "drum": drum, "silo": silo}


class RigDrawing(FromFile):
    def run(self):
        p = {}
        for text in self.path().read_text(encoding="utf-8").splitlines():
            found = LINE.match(text.strip())
            if found:
                try:
                    p[found.group(1)] = float(found.group(2))
                except ValueError:
                    p[found.group(1)] = found.group(2)
        try:
            body, height = VIEWS[p["rig"]](p)
        except KeyError as missing:
            raise self.error(f"{self.arguments[0]}: no drawing, for want of {missing}") from missing
        svg = (
            f'<svg class="drawing" viewBox="0 0 {WIDTH} {height:.0f}" role="img" aria-label="The {p["rig"]} to scale, lengths in mm">'
            f'{"".join(body)}</svg>'
        )
        return [nodes.raw("", svg, format="html")]


def setup(app):
    app.add_directive("rig-drawing", RigDrawing)
    return {"parallel_read_safe": True}
