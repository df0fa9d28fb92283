# SPDX-License-Identifier: GPL-2.0-or-later
"""Questions that the site answers: is the answer where the clicks from the start page lead? They are those of
doc/develop/questions.csv and of tests/tools/unseen_questions.csv, which no page shows: readers are tried with them.

Columns: question; clicks, the words of the links or, on the page itself, of the headings, divided by ` > `; answer, words
that must stand there. After a build every click is looked up in the pages that were made; what is not found is a warning,
and scripts/docs makes that an error. Of a link in the sidebar the words are the page's title.
"""
import html.parser
import pathlib
import re
import urllib.parse

from sphinx.util import logging
from tools import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLES = [ROOT / "doc/develop/questions.csv", ROOT / "tests/tools/unseen_questions.csv"]
log = logging.getLogger(__name__)


class Page(html.parser.HTMLParser):
    """Links {words: address} and the text of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.words, self.open = {}, [], None
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        if tag == "a" and dict(attributes).get("href"):
            self.open = dict(attributes)["href"], []

    def handle_endtag(self, tag):
        if tag == "a" and self.open:
            address, words = self.open
            self.links.setdefault(plain("".join(words)), address)
            self.open = None

    def handle_data(self, data):
        self.words.append(data)
        if self.open:
            self.open[1].append(data)

    @property
    def text(self):
        return plain("".join(self.words))


def plain(text):
    return re.sub(r"\s+", " ", text).strip()


def fault_of(root, clicks, answer):
    """What does not lead to the answer; empty if all does."""
    path = root / "index.html"
    for click in clicks:
        page = Page(path)
        if click not in page.links:
            return f"{path.relative_to(root)} has no link '{click}'"
        address = urllib.parse.urlparse(page.links[click])
        if address.path:
            path = (path.parent / address.path).resolve()
        if not path.is_file():
            return f"'{click}' leads to {path}, which is not there"
    return "" if plain(answer) in Page(path).text else f"{path.relative_to(root)} does not say '{answer}'"


def look_up(app, exception):
    if exception or app.builder.name != "html":
        return
    root = pathlib.Path(app.outdir).resolve()
    for table in TABLES:
        for row in tables.read(table, ["question", "answer", "clicks"], "bring it back"):
            fault = fault_of(root, row["clicks"].split(" > "), row["answer"])
            if fault:
                log.warning(f"{table.name}: {row['question']}: {fault}")


def setup(app):
    app.connect("build-finished", look_up)
    return {"parallel_read_safe": True}
