# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {claims}: a list of findings, a line a page, with the question and the claim that the page itself states.

    ```{claims}
    grain_size
    end_walls
    ```

The pages lie beside the one with the directive. The question is a page's title; the claim is the first sentence of its first
bold paragraph. The pages also become entries of the contents.
"""
import pathlib
import re

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList


def question_and_claim(path):
    text = path.read_text(encoding="utf-8")
    title = re.match(r"# (.+)\n", text)
    claim = re.search(r"^\*\*(.+?(?:\.(?= |\*\*)))", text, re.M)
    if not title or not claim:
        raise ValueError(
            f"{path.name}: a finding begins with its question as title and its claim in bold, a whole sentence"
        )
    return title.group(1), claim.group(1)


class Claims(Directive):
    has_content = True

    def run(self):
        environment = self.state.document.settings.env
        folder = pathlib.Path(environment.doc2path(environment.docname)).parent
        pages = [line.strip() for line in self.content if line.strip()]
        lines = []
        for page in pages:
            path = folder / f"{page}.md"
            environment.note_dependency(str(path))
            try:
                question, claim = question_and_claim(path)
            except (OSError, ValueError) as fault:
                raise self.error(str(fault)) from fault
            lines.append(f"- [{question}]({page}.md) {claim}")
        lines += ["", "```{toctree}", ":hidden:", *pages, "```"]
        holder = nodes.Element()
        self.state.nested_parse(StringList(lines), self.lineno, holder, match_titles=True)
        return holder.children


def setup(app):
    app.add_directive("claims", Claims)
    return {"parallel_read_safe": True}
