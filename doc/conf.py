# SPDX-License-Identifier: GPL-2.0-or-later
# The site: MyST pages under Sphinx with furo's looks. scripts/docs builds it.
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "doc" / "_ext")]

project = "ViElTo for LIGGGHTS"
author = "see AUTHORS"
release = re.search(r"VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text().split("project(")[1])[1]
extensions = [
    "myst_parser",
    "equations",
    "results",
    "claims",
    "from_code",
    "drawing",
    "plot",
    "scores",
    "again",
    "held_together",
    "questions",
]
myst_enable_extensions = ["colon_fence", "dollarmath", "deflist"]
myst_heading_anchors = 3
exclude_patterns = ["_ext"]
html_theme = "furo"
html_title = f"ViElTo for LIGGGHTS {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_show_sphinx = False
html_show_copyright = False
html_math_renderer = "katex"
math_number_all = False
math_eqref_format = "({number})"


def setup(app):
    from pygments.lexers.special import TextLexer

    app.add_lexer("arrows", TextLexer)


# other sites are looked up where there is a network: scripts/docs --linkcheck
linkcheck_ignore = [r"https?://"]
