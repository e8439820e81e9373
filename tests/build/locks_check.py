#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Locks of the sources and of Documentation/locking.rst are the same; "held" is asserted.

- Each lock that is declared is in a table of locking.rst, as struct.member or by its name,
  and each lock of the table is declared.
- A function whose comment says that a lock is held has an assertion.

usage: locks_check.py locks|held FILE.rst FOLDER|FILE...
"""
import re
import sys
from pathlib import Path

# functions without assertion although their comment says "held"; goes down only
LIMIT = 0

KIND = (r"(?:struct\s+(?:mutex|rt_mutex|rw_semaphore|semaphore|percpu_rw_semaphore)|"
        r"(?:raw_)?spinlock_t|rwlock_t|seqlock_t|seqcount\w*_t|local_lock_t)")
MEMBER = re.compile(r"^\s+" + KIND + r"\s+(\w+)\s*;")
GLOBAL = re.compile(r"^(?:static\s+)?(?:" + KIND + r"\s+(\w+)\s*;|DEFINE_\w*(?:MUTEX|LOCK|SEMAPHORE|"
                    r"RWSEM|SEQ)\w*\((\w+)|DECLARE_RWSEM\((\w+))")
STRUCT = re.compile(r"^struct (\w+) \{")
ROW = re.compile(r"^   \* - (.*)")
NOT_OURS = {"RTNL", "mmap_lock"}
# a comment, then the first line of a definition
FUNCTION = re.compile(r"/\*((?:[^*]|\*(?!/))*)\*/\n([A-Za-z_][^;{}#]*?\b(\w+)\([^;{}]*\))\n\{\n(.*?)\n\}",
                      re.S)
HELD = re.compile(r"(?<!No lock is )\bheld\b")
# the list of slaves is held, too
LIST = re.compile(r"\b(?:list|slaves)(?:[\s*]|of|slaves|is)+held\b")
ASSERTION = re.compile(r"\b\w*assert\w*\(|\bASSERT_RTNL\(|\brcu_dereference_protected\(")
# they take or release the lock
TAKES = {"ec_session_trylock", "ec_ioc_lock_session", "enter"}


def files(paths):
    for p in map(Path, paths):
        yield from sorted(p.rglob("*.[ch]")) if p.is_dir() else [p]


def declared(paths):
    """Name of each lock: file and line."""
    locks = {}
    for path in files(paths):
        struct = None
        for number, line in enumerate(path.read_text().split("\n"), 1):
            m = STRUCT.match(line)
            if m:
                struct = m.group(1)
            elif line.startswith("}"):
                struct = None
            m = MEMBER.match(line) if struct else None
            if m:
                locks[f"{struct}.{m.group(1)}"] = f"{path}:{number}"
            m = GLOBAL.match(line)
            if m:
                locks[m.group(1) or m.group(2) or m.group(3)] = f"{path}:{number}"
    return locks


def described(rst):
    """Names in the first column of the first table."""
    names, table = set(), False
    for line in Path(rst).read_text().split("\n"):
        if line.startswith(".. list-table::"):
            if names:
                break
            table = True
        m = ROW.match(line) if table else None
        if m and m.group(1) != "lock":
            names.add(m.group(1).strip("`"))
    return names - NOT_OURS


def check_locks(rst, paths):
    have, want = declared(paths), described(rst)
    bad = [f"{have[name]}: lock {name} is not in {rst}" for name in have if name not in want]
    return bad + [f"{rst}: lock {name} is not declared" for name in sorted(want - set(have))]


def check_held(paths):
    bad = []
    for path in files(paths):
        for m in FUNCTION.finditer(path.read_text()):
            comment, name, body = m.group(1), m.group(3), m.group(4)
            if HELD.search(LIST.sub("", comment)) and not ASSERTION.search(body) and name not in TAKES:
                bad.append(f"{path}: {name}(): the comment says \"held\", no assertion checks it")
    return bad


def main():
    what, rst, paths = sys.argv[1], sys.argv[2], sys.argv[3:]
    bad = check_locks(rst, paths) if what == "locks" else check_held(paths)
    limit = 0 if what == "locks" else LIMIT
    print("\n".join(bad))
    if len(bad) < limit:
        print(f"{len(bad)} left: set LIMIT to that")
    return len(bad) != limit


sys.exit(main())
