#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Documentation/simulator.rst has the slaves of each built-in segment, and no others.

A table below "Names of the slaves" has rows of segment, position, name and device, as
devices/sim/describe_builtin.c describes them; "d1 to d100" stands for a repetition.
usage: segments.py [PAGE]
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def built_in():
    """(segment, position, name, device) of each slave, repetitions in one row."""
    text = (ROOT / "devices/sim/describe_builtin.c").read_text()
    for name, body in re.findall(r'\.name = "(\w+)",\s*\.text =\s*((?:"[^"\n]*"\s*)+)', text):
        position = 0
        for line in "".join(re.findall(r'"([^"\n]*)"', body)).split("\\n"):
            words = line.split()
            if words[:1] == ["slave"]:
                yield name, str(position), words[1], words[2]
                position += 1
            elif words[:1] == ["repeat"]:
                n = int(words[1])
                yield (name, f"{position} to {position + n - 1}",
                       f"{words[3]}1 to {words[3]}{n}", words[4])
                position += n


def shown(page):
    """The same in the page."""
    text = page.read_text()
    table = text[text.index("Names of the slaves\n"):].split("\n=====")[2]
    for line in table.split("\n"):
        cells = re.split(r"\s{2,}", line.replace("``", "").strip())
        if len(cells) >= 4 and cells[0][0] != "=":
            yield tuple(cells[:4])


def main():
    page = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "Documentation/simulator.rst"
    expected, found = list(built_in()), list(shown(page))
    bad = [f"{page.name}: no row {' '.join(r)}" for r in expected if r not in found]
    bad += [f"{page.name}: no slave {' '.join(r)}" for r in found if r not in expected]
    print("\n".join(bad) or f"{len(expected)} rows")
    return 1 if bad or not expected else 0


sys.exit(main())
