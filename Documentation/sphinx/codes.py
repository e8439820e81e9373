#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Page of the codes that slaves report: texts from the tables of the sources, with remedies.

The remedy of an AL status code is that of "ethercat why", if it has one. The others are in
remedies.txt: kind, code (? is any digit, * any rest; the first row that matches counts), remedy.
A code without remedy is an error, and a row that matches no code.
usage: codes.py SOURCES [--remedies]    SOURCES: the folder with master/ and lib/; writes
                                        reStructuredText to stdout, or only the remedies
"""
import re
import sys
import textwrap
from fnmatch import fnmatchcase
from pathlib import Path

# kind, file pattern, name of the table, digits of a code, heading, text before the table
TABLES = (
    ("al", "master/wire/al*.c", r"codes", 4, "AL status codes",
     "A slave that refuses a state, or leaves OP, reports one of these in register 0x0134. Commands "
     "that show it: ``ethercat why``, ``ethercat slaves -v``, ``ethercat log``. Codes from 0x8000 "
     "on are the vendor's: see the manual of the slave."),
    ("abort", "master/wire/coe*.c", r"\w*abort\w*", 8, "SDO abort codes",
     "The reply of a slave to an SDO that it refuses: an upload, a download, or a startup SDO."),
    ("mailbox", "master/wire/mbox*.c", r"errors", 4, "Mailbox error replies",
     "A slave that cannot process a mailbox message at all, of any protocol."),
    ("foe", "master/wire/foe*.c", r"texts", 4, "FoE errors",
     "Files and firmware: ``ethercat foe_read``, ``foe_write`` and ``firmware``."),
    ("soe", "master/wire/soe*.c", r"soe_errors", 4, "SoE errors",
     "Drives with IDNs: ``ethercat soe_read`` and ``soe_write``."),
    ("emergency", "master/wire/emergency.c", r"emergencies", 4, "CoE emergencies",
     "``ethercat emergencies`` shows the last ones of each slave, and ``ethercat why`` one that "
     "stands; x is any digit. Codes of CiA 301, of all devices."),
    ("emergency", "master/wire/emergency.c", r"drive_emergencies", 4, "CoE emergencies of drives",
     "Codes of CiA 402, of a slave that maps the status word 0x6041. A code that is not here is "
     "in the table before, or in the manual of the drive."),
)
REMEDIES = Path(__file__).with_name("remedies.txt")
HEAD = """.. SPDX-License-Identifier: GPL-2.0-only

=====
Codes
=====

What slaves report, and what to do. The texts are those of the log and of the commands: ``make doc``
reads them from the sources. ``ethercat why`` names the cause in the bus at hand (:doc:`why`).
"""
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
ROW = re.compile(r"\{((?:[^{}\"]|\"(?:\\.|[^\"\\])*\")*)\}")
MASKS = (0xf000, 0xff00, 0xfff0, 0xffff)


def constants(folder):
    """Values of the EC_... names in the headers of master/wire."""
    found = {}
    for path in sorted(folder.glob("master/wire/*.h")):
        for name, value in re.findall(r"\b(EC_\w+)\s*=?\s+(0x[0-9a-fA-F]+|\d+)\b",
                                      COMMENT.sub("", path.read_text())):
            found[name] = int(value, 0)
    return found


def rows(path, table, names):
    """(numbers, text) of each row of the tables with that name."""
    text = COMMENT.sub("", path.read_text())
    for body in re.findall(r"\b(?:%s)\[\] = \{\n(.*?)\n\t*\};" % table, text, re.S):
        for row in ROW.findall(body):
            strings = re.findall(r'"((?:\\.|[^"\\])*)"', row)
            if not strings:
                continue
            words = re.sub(r'"(?:\\.|[^"\\])*"', "", row).replace(",", " ").split()
            numbers = [names[w] if w in names else int(w, 0) for w in words
                       if w in names or re.match(r"0x|\d", w)]
            yield numbers, "".join(strings)


def code(numbers, digits):
    """A code or a group as text."""
    if len(numbers) > 1 and numbers[0] in MASKS:
        fixed = f"{numbers[0]:04x}".count("f")
        return "0x" + f"{numbers[1]:04x}"[:fixed] + "x" * (digits - fixed)
    return f"0x{numbers[0]:0{digits}x}"


def own(folder):
    """Remedies of "ethercat why"."""
    names = {}
    return {code(n, 4): t for n, t in rows(folder / "lib/tools/why_codes.c", "al_remedies", names)}


def read_remedies():
    for line in REMEDIES.read_text().split("\n"):
        if line and not line.startswith("#"):
            yield line.split(None, 2)


def marked(text):
    """Commands and functions in a text as literals."""
    return re.sub(r"'((?:ethercat|dmesg)[^']*)'|\b(ecrt_\w+\(\))",
                  lambda m: f"``{m[1] or m[2]}``", text)


def cells(columns, widths):
    wrapped = [textwrap.wrap(c, w, break_on_hyphens=False, break_long_words=False) or [""]
               for c, w in zip(columns, widths)]
    for i in range(max(map(len, wrapped))):
        yield "  ".join((w[i] if i < len(w) else "").ljust(n)
                        for w, n in zip(wrapped, widths)).rstrip()


def section(title, before, lines):
    widths = (12, 36, 48)
    rule = "  ".join("=" * w for w in widths)
    out = ["", title, "=" * len(title), "", *textwrap.wrap(before, 100, break_on_hyphens=False),
           "", rule, *cells(("code", "meaning", "remedy"), widths), rule]
    for line in lines:
        out += cells(line, widths)
    return out + [rule]


def main():
    folder = Path(sys.argv[1])
    names, tool, given = constants(folder), own(folder), list(read_remedies())
    used, bad, out, texts = set(), [], [HEAD.rstrip()], []
    for kind, pattern, table, digits, title, before in TABLES:
        lines = []
        found = [r for p in sorted(folder.glob(pattern)) for r in rows(p, table, names)]
        for numbers, text in found:
            shown = code(numbers, digits)
            remedy = tool.get(shown) if kind == "al" else None
            match = next((i for i, (k, c, _) in enumerate(given)
                          if k == kind and fnmatchcase(shown, c)), None)
            if not remedy and match is None:
                bad.append(f"{REMEDIES.name}: no remedy of {kind} {shown} ({text})")
                continue
            if not remedy:
                used.add(match)
            lines.append((shown, text, marked(remedy or given[match][2])))
        if not found:
            bad.append(f"codes.py: no table '{table}' in {pattern}")
        out += section(title, before, lines)
        texts += [before, *(remedy for _, _, remedy in lines)]
    bad += [f"{REMEDIES.name}: '{k} {c}' matches no code, or one with a remedy of the tool"
            for i, (k, c, _) in enumerate(given) if i not in used]
    if bad:
        sys.exit("\n".join(bad))
    print("\n".join(texts if "--remedies" in sys.argv else out))


main()
