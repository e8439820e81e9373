#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""A word of memory that an application has mapped is read once, by a marked access.

The application may change it at any time: the compiler must not read it again after it
was checked. What the kernel writes there may be a plain assignment.
usage: mapped_check.py FILE...
"""
import re
import sys
from pathlib import Path

# requests, emergencies, the exchange with a cycle of the kernel
WORD = re.compile(r"(?:\w+(?:->|\.))*\b(?:rec|ring|area|x|exchange(?:\(\w*\))?)->\w+")
MARKED = re.compile(r"(?:&|\b(?:READ_ONCE|WRITE_ONCE|ec_status_read)\()$")
ASSIGNED = re.compile(r"\s*=[^=]")
COMMENT = re.compile(r"/\*.*?\*/", re.S)


def main():
    bad = []
    for name in sys.argv[1:]:
        text = COMMENT.sub(lambda m: "\n" * m.group().count("\n"), Path(name).read_text())
        for number, line in enumerate(text.split("\n"), 1):
            for m in WORD.finditer(line):
                if not MARKED.search(line[:m.start()]) and not ASSIGNED.match(line[m.end():]):
                    bad.append(f"{name}:{number}: {m.group()} is read by an unmarked access")
    print("\n".join(bad))
    return 1 if bad else 0


sys.exit(main())
