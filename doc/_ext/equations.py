# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations drawn by Debian's KaTeX when the site is built: HTML with KaTeX's style and fonts, which looks the same in every
browser and needs no script; MathML beside it for those who have pages read to them."""
import json
import pathlib
import shutil
import subprocess

from docutils import nodes
from sphinx.errors import ExtensionError
from sphinx.util.math import get_node_equation_number

FOLDER = pathlib.Path("/usr/share/javascript/katex")
KATEX = FOLDER / "katex.js"
# One equation a line on stdin, its HTML or its fault a line on stdout.
TRANSLATOR = """
const katex = require(process.argv[1]);
require('readline').createInterface({input: process.stdin}).on('line', line => {
  const {text, display} = JSON.parse(line);
  let answer;
  try { answer = {html: katex.renderToString(text, {displayMode: display, output: 'htmlAndMathml', strict: 'error'})}; }
  catch (fault) { answer = {fault: String(fault.message)}; }
  console.log(JSON.stringify(answer));
});
"""


class Translator:
    """One node process for the whole site; it is started by the first equation."""

    process = None

    def __call__(self, text, display):
        try:
            if self.process is None:
                self.process = subprocess.Popen(
                    ["node", "-e", TRANSLATOR, str(KATEX)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
                )
            print(json.dumps({"text": text, "display": display}), file=self.process.stdin, flush=True)
            answer = json.loads(self.process.stdout.readline())
        except (OSError, ValueError) as fault:
            raise ExtensionError(f"equations need node and {KATEX}; scripts/install-packages docs") from fault
        if "fault" in answer:
            raise ExtensionError(f"no equation: {text}: {answer['fault']}")
        return answer["html"]

    def end(self, *_):
        if self.process is not None:
            self.process.stdin.close()
            self.process.stdout.close()
            self.process.wait()
            self.process = None


translate = Translator()


def inline(writer, node):
    writer.body.append(translate(node.astext(), False))
    raise nodes.SkipNode


def displayed(writer, node):
    writer.body.append(writer.starttag(node, "div", CLASS="math"))
    if node["number"]:
        number = get_node_equation_number(writer, node)
        writer.body.append(f'<span class="eqno">({number})</span>')
    writer.body.append(translate(node.astext(), True) + "</div>\n")
    raise nodes.SkipNode


def copy_style(app, exception):
    if exception or app.builder.format != "html":
        return
    to = pathlib.Path(app.outdir) / "_static/katex"
    (to / "fonts").mkdir(parents=True, exist_ok=True)
    shutil.copy(FOLDER / "katex.min.css", to)
    for font in (FOLDER / "fonts").glob("*.woff2"):
        shutil.copy(font, to / "fonts")


def setup(app):
    app.add_html_math_renderer("katex", (inline, None), (displayed, None))
    app.add_css_file("katex/katex.min.css")
    app.connect("build-finished", translate.end)
    app.connect("build-finished", copy_style)
    return {"parallel_read_safe": True}
