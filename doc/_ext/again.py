# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {again}: how a finding is made again, folded. Its title is the time that takes, its lines are commands.

    ```{again} 75 minutes of one core
    scripts/campaign velocity_sweep
    ```
"""
import html

from docutils import nodes
from docutils.parsers.rst import Directive


class Again(Directive):
    has_content = True
    required_arguments = 1
    final_argument_whitespace = True

    def run(self):
        commands = "\n".join(self.content)
        time = html.escape(self.arguments[0])
        return [
            nodes.raw("", f"<details><summary>Make it again: {time}</summary>", format="html"),
            nodes.literal_block(commands, commands, language="sh"),
            nodes.raw("", "</details>", format="html"),
        ]


def setup(app):
    app.add_directive("again", Again)
    return {"parallel_read_safe": True}
