# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {mixer-drawing} cases/mixer/mixer.par: the mixer along its shaft and from the side, to scale, with the
dimensions that stand in the parameter file. Lines take the colour of the page's text."""
import math

from docutils import nodes

from from_code import LINE, FromFile

TEXT, ARROW, GAP = 25, 9, 46  # mm on the drawing


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
    out.append(words(middle + slice_width / 2 + 12, below, f"slice of {p['slicePaddles']:.0f} paddles"))
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


class MixerDrawing(FromFile):
    def run(self):
        p = {}
        for text in self.path().read_text(encoding="utf-8").splitlines():
            found = LINE.match(text.strip())
            try:
                p[found.group(1)] = float(found.group(2))
            except (AttributeError, ValueError):
                continue
        try:
            body = end_view(p, 330, 190) + side_view(p, 70, 610)
        except KeyError as missing:
            raise self.error(f"{self.arguments[0]}: has no {missing.args[0]}") from missing
        svg = (
            '<svg class="drawing" viewBox="0 0 900 850" role="img" aria-label="The mixer along its shaft and from the side, '
            f'lengths in mm">{"".join(body)}</svg>'
        )
        return [nodes.raw("", svg, format="html")]


def setup(app):
    app.add_directive("mixer-drawing", MixerDrawing)
    return {"parallel_read_safe": True}
