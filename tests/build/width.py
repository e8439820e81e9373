#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""No block and no table of the HTML pages is wider than its page in a window of 1200 px.

Calculates with the sizes of pages.css and of the theme instead of a browser: a line of a block
does not wrap, and a cell of a table is at least as wide as its longest word.
usage: width.py FOLDER      what "make doc" wrote
"""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

WINDOW = 1200 - 15      # without the bar for scrolling down
SIDEBAR, INDENT = 220, 30
MONO = 0.602            # of the font size: DejaVu Sans Mono and Menlo, the widest of the theme
SERIF = 0.62            # a wide letter
TEXT = 17               # px, font size of the theme
CODE = 0.9 * TEXT
INDENTED = ("li", "dd", "blockquote")
VOID = ("br", "img", "link", "meta", "input", "hr", "col")


class Page(HTMLParser):
    """Widths that a page needs: (what, px)."""

    def __init__(self, pre, cell):
        super().__init__()
        self.pre, self.cell = pre, cell         # (font size, padding of both sides), padding
        self.open, self.found = [], []
        self.text, self.row, self.word = None, None, 0

    def inside(self, *tags):
        return sum(t in tags for t in self.open)

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)
        if tag == "pre":
            self.text = ""
        elif tag == "table":
            self.row, self.columns, self.first = 0, [], ""
        elif tag == "tr":
            self.row = 0
        elif tag in ("td", "th"):
            self.word = 0

    def handle_data(self, data):
        if self.text is not None:
            self.text += data
        elif self.inside("td", "th"):
            self.first = self.first or data.strip()
            size = CODE * MONO if self.inside("code") else TEXT * SERIF
            self.word = max([self.word] + [len(w) * size for w in data.split()])

    def handle_endtag(self, tag):
        indent = INDENT * self.inside(*INDENTED)
        if tag == "pre":
            size, padding = self.pre
            line = max(self.text.split("\n"), key=len)
            self.found.append((line, len(line) * size * MONO + padding + indent))
            self.text = None
        elif tag in ("td", "th"):
            self.columns += [0] * (self.row + 1 - len(self.columns))
            self.columns[self.row] = max(self.columns[self.row], self.word + self.cell)
            self.row += 1
        elif tag == "table":
            self.found.append((f"table with '{self.first}'", sum(self.columns) + indent))
        while tag not in VOID and self.open and self.open.pop() != tag:
            pass


def number(css, rule, name):
    """Pixels of a property: the only number, or the one behind another."""
    body = re.search(re.escape(rule) + r"[^{]*\{([^}]*)\}", css)
    found = re.search(rf"(?<![\w-]){name}: (?:\d+p?x? )?(\d+)px", body[1]) if body else None
    if not found:
        sys.exit(f"width.py: pages.css has no {name} of {rule}")
    return int(found[1])


def main():
    folder = Path(sys.argv[1])
    css = (folder / "_static/pages.css").read_text()
    page = number(css, "div.document", "max-width")
    room = min(page, WINDOW) - SIDEBAR - 2 * number(css, "div.body", "padding")
    pre = number(css, "\npre", "font-size"), 2 * number(css, "\npre", "padding") + 2
    cell = 2 * number(css, "table.docutils td", "padding") + 1
    bad, count = [], 0
    for path in sorted(folder.glob("*.html")):
        text = path.read_text()
        if "_static/pages.css" not in text:
            bad.append(f"{path.name}: has no pages.css")
        if path.name in ("genindex.html", "search.html"):
            continue            # its tables wrap inside words
        parser = Page(pre, cell)
        parser.feed(re.sub(r"(?s)<script.*?</script>", "", text))
        count += len(parser.found)
        bad += [f"{path.name}: {round(px)} px of {room}: {what}" for what, px in parser.found
                if px > room]
    print("\n".join(bad) or f"{count} blocks and tables, {room} px")
    return 1 if bad or not count else 0


sys.exit(main())
