# SPDX-License-Identifier: GPL-2.0-or-later
"""A number, its uncertainty and its unit stay on one line: the blanks of "5 ± 3 %" and "12 mm" do not break."""
import re

from docutils import nodes

UNITS = "%|°|mm|m/s|1/s|rpm|W|N|Pa|kPa|MPa|kg|deg|kB"
BREAKS = re.compile(rf"(?<=[\d.]) (?=(?:{UNITS})(?![\w]))|(?<=\d) (?=±)|(?<=±) (?=\d)")


def hold(app, doctree, docname):
    for text in list(doctree.findall(nodes.Text)):
        if not isinstance(text.parent, (nodes.literal, nodes.literal_block, nodes.raw, nodes.math)):
            held = BREAKS.sub("\u00a0", text)
            if held != text:
                text.parent.replace(text, nodes.Text(held))


def setup(app):
    app.connect("doctree-resolved", hold)
    return {"parallel_read_safe": True}
