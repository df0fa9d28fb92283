# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {again} findings/end_walls: how a finding is made again, folded.

The program `again` of that folder does it. The first line of comment behind its `#!` is the time that it takes, the page's
title of the fold; behind it stand what it needs and the commands, which the page shows.
"""
import re

from docutils import nodes
from from_code import FromFile

PREAMBLE = re.compile(r"#!.*|set -euo pipefail|cd \"\$\(dirname .*|# SPDX.*|")


def time_and_commands(text):
    lines = [line for line in text.splitlines() if not PREAMBLE.fullmatch(line)]
    if not lines or not lines[0].startswith("# "):
        raise ValueError("the first comment is the time that it takes")
    return lines[0][2:], lines[1:]


class Again(FromFile):
    def run(self):
        program = self.path() / "again"
        try:
            self.state.document.settings.env.note_dependency(str(program))
            time, lines = time_and_commands(program.read_text(encoding="utf-8"))
        except (OSError, ValueError) as fault:
            raise self.error(f"{program}: {fault}") from fault
        summary = f"<details><summary>Make it again: {self.arguments[0]}/again, {time}</summary>"
        commands = "\n".join(lines)
        return [
            nodes.raw("", summary, format="html"),
            nodes.literal_block(commands, commands, language="sh"),
            nodes.raw("", "</details>", format="html"),
        ]


def setup(app):
    app.add_directive("again", Again)
    return {"parallel_read_safe": True}
