#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""No 64-bit value is shared by READ_ONCE() and WRITE_ONCE().

On a kernel of 32 bits these take two accesses. ec_read64() and ec_write64() take one,
and the status page has ec_status_begin() and ec_status_copy(); see master/base/once64.h.
What a lock protects is read in the file that takes the lock.
usage: once64_check.py FOLDER...
"""
import re
import sys
from pathlib import Path

ALLOWED = {
    "master/cycle/receive.c:ec_cycle_do_receive": "between ec_status_begin() and ec_status_end()",
    "master/cycle/dc_datagrams.c:ec_dc_datagrams_judge": "its caller has called ec_status_begin()",
    "master/cycle/late.c:late_add": "between ec_status_begin() and ec_status_end()",
    "master/cycle/late.c:ec_late_work": "between ec_status_begin() and ec_status_end()",
    "master/cycle/cycle_run.c:cycle_run_publish": "between ec_status_begin() and ec_status_end()",
}
# a lock protects it, which only this file takes
ONE_FILE = {"dc->phase": "dc_app.c"}
MEMBER = re.compile(r"^\s+(?:const\s+)?(\w+)\s+\**(\w+)(?:\[\w+\])?;")
WIDE = {"u64", "s64", "__u64", "__s64", "aligned_u64", "uint64_t", "int64_t", "ktime_t"}
ONCE = re.compile(r"\b(?:READ|WRITE)_ONCE\(((?:[^(),]|\([^()]*\))*?(?:->|\.|\*)(\w+)(?:\[[^]]*\])?)[,)]")
FUNCTION = re.compile(r"^[A-Za-z_][^;=]*?\b(\w+)\([^;]*$")
COMMENT = re.compile(r"/\*.*?\*/", re.S)


def strip(text):
    return COMMENT.sub(lambda m: "\n" * m.group().count("\n"), text)


def members(paths):
    """Names of members that have 64 bits in all structures that have one so named."""
    wide, narrow = set(), set()
    for path in paths:
        for line in strip(path.read_text()).split("\n"):
            m = MEMBER.match(line)
            if m:
                (wide if m.group(1) in WIDE else narrow).add(m.group(2))
    return wide - narrow


def check(path, wide, bad, used):
    name = ""
    for number, line in enumerate(strip(path.read_text()).split("\n"), 1):
        if line[:1].isalpha() and FUNCTION.match(line):
            name = FUNCTION.match(line).group(1)
        for m in ONCE.finditer(line):
            where = f"{path}:{name}"
            if m.group(2) not in wide:
                continue
            used.add(where)
            if where not in ALLOWED:
                bad.append(f"{path}:{number}: {name}(): {m.group(1)} has 64 bits")


def main():
    bad, used = [], set()
    files = [p for d in sys.argv[1:] for p in sorted(Path(d).rglob("*.[ch]"))]
    wide = members([p for p in files if p.suffix == ".h"] + [Path("include/uapi/ethercat_map.h")])
    for path in files:
        check(path, wide, bad, used)
        bad += [f"{path}: {member} is for {name} only, which takes its lock"
                for member, name in ONE_FILE.items()
                if path.name != name and
                re.search(re.escape(member) + r"\b", strip(path.read_text()))]
    bad += [f"{w} is allowed but needs it not; remove it" for w in ALLOWED if w not in used]
    print("\n".join(bad))
    return 1 if bad else 0


sys.exit(main())
