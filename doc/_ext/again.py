# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {again}: how a finding is made again, folded. A finding whose folder is named as its page ends with it unasked.

The program `again` does it, in the folder of findings/ that is named as the page is, or in the one that is stated. The first
line of comment behind its `#!` is the time that it takes, the page's
title of the fold; behind it stand what it needs and the commands, which the page shows.
"""
import re

from docutils import nodes
from docutils.parsers.rst import Directive
from results import ROOT, placed

PREAMBLE = re.compile(r"#!.*|set -euo pipefail|cd \"\$\(dirname .*|# SPDX.*|")


def time_and_commands(text):
    lines = [line for line in text.splitlines() if not PREAMBLE.fullmatch(line)]
    if not lines or not lines[0].startswith("# "):
        raise ValueError("the first comment is the time that it takes")
    return lines[0][2:], lines[1:]


class Again(Directive):
    optional_arguments = 1

    def run(self):
        program = placed(self, "/".join([*self.arguments, "again"]))
        try:
            time, lines = time_and_commands(program.read_text(encoding="utf-8"))
        except (OSError, ValueError) as fault:
            raise self.error(f"{program}: {fault}") from fault
        summary = f"<details><summary>Make it again: {program.relative_to(ROOT)}, {time}</summary>"
        commands = "\n".join(lines)
        return [
            nodes.raw("", summary, format="html"),
            nodes.literal_block(commands, commands, language="sh"),
            nodes.raw("", "</details>", format="html"),
        ]


def end_finding(app, docname, source):
    """A finding ends with how it is made again."""
    room, _, name = docname.rpartition("/")
    if room == "findings" and (ROOT / room / name / "again").is_file():
        source[0] += "\n\n```{again}\n```\n"


def setup(app):
    app.add_directive("again", Again)
    app.connect("source-read", end_finding)
    return {"parallel_read_safe": True}
