# SPDX-License-Identifier: GPL-2.0-or-later
# The site: MyST pages under Sphinx with furo's looks. Built by scripts/docs, which makes reference/ from the code first.
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "doc" / "_ext"))

project = "ViElTo for LIGGGHTS"
author = "the authors (AUTHORS)"
release = re.search(r"VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text().split("project(")[1])[1]
extensions = ["myst_parser", "results", "sphinx.ext.mathjax"]
myst_enable_extensions = ["colon_fence", "dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3
exclude_patterns = ["_ext"]
html_theme = "furo"
html_title = f"ViElTo for LIGGGHTS {release}"
html_static_path = ["_static"]
html_css_files = ["results.css"]
html_show_sphinx = False
numfig = True
math_number_all = False
math_eqref_format = "({number})"


def setup(app):
    from pygments.lexers.special import TextLexer

    app.add_lexer("arrows", TextLexer)


linkcheck_ignore = [r"https?://"]
