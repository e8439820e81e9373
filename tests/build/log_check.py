#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Every line that a module can log while it runs is rate-limited, and no text is an errno.

Nothing is logged while a raw spinlock is held: a slow console would keep the CPU. An error is "%pe" or a text of its own: "result -110" tells a reader nothing. A call that prints is accepted in an __init function, by a limited macro, through
ec_log_event(), or in one of the functions below, each with its reason.
usage: log_check.py FOLDER...
"""
import re
import sys
from pathlib import Path

ALLOWED = {
    "master/base/log.c:print": "its callers limit",
    "master/base/log.c:ec_log_flush": "one line in 10 s",
    "master/link/link.c:ec_link_trace": "asks __ratelimit()",
    "master/base/base.h:ec_dbg_slave": "asks ec_log_debug()",
    "master/boundary/cdev.c:make_nodes": "insmod only",
    "master/master.c:master_check_name": "insmod only",
    "master/master.c:check_backups": "insmod only",
    "master/master.c:check_names": "insmod only",
    "master/master.c:ec_masters_create": "insmod only",
    "devices/sim/sim_module.c:describe": "insmod only",
    "devices/sim/sim_module.c:build": "insmod only",
    "devices/sim/sim_module.c:respond": "insmod only",
    "devices/sim/sim_responder.c:attach_all": "insmod only",
}
PRINTS = re.compile(
    r"\b(printk|_printk|vprintk|(?:pr|dev|netdev|netif)_(?:emerg|alert|crit|err|warn|notice|info)"
    r"|WARN(?!_ON_ONCE|_ONCE)(?:_ON|_TAINT)?|dump_stack|print_hex_dump\w*)\s*\(")
LOGS = re.compile(r"\bec_(?:slave_|master_)?(?:log\w*|report\w*|err|warn\w*|info|dbg\w*|fail)\s*\(")
LOCK = re.compile(r"\braw_spin_(un)?lock\w*\s*\(")
FUNCTION = re.compile(r"^[A-Za-z_][^;=]*?\b(\w+)\([^;]*$")
# a signed number behind such a word; one with a unit is none
ERRNO = re.compile(r'"[^"\n]*\b(result|error|errno|failed|ret)\b[^"%]{0,4}%d(?! \w)')
COMMENT = re.compile(r"/\*.*?\*/", re.S)


def strip(text):
    text = COMMENT.sub(lambda m: "\n" * m.group().count("\n"), text)
    return re.sub(r'"(?:\\.|[^"\\])*"', '""', text)


def check(path, bad, used):
    name, init, held = "", False, False
    for number, line in enumerate(path.read_text().split("\n"), 1):
        if ERRNO.search(line):
            bad.append(f"{path}:{number}: a number of errno; print %pe or a text")
    for number, line in enumerate(strip(path.read_text()).split("\n"), 1):
        macro = re.match(r"#\s*define\s+(\w+)", line)
        if macro:
            name, init = macro.group(1), False
        elif line[:1].isalpha() and FUNCTION.match(line):
            name, init = FUNCTION.match(line).group(1), "__init" in line
        lock = LOCK.search(line)
        if lock or line == "}":
            held = bool(lock and not lock.group(1))
        if held and (PRINTS.search(line) or LOGS.search(line)):
            bad.append(f"{path}:{number}: {name}() logs under a raw spinlock")
        if not PRINTS.search(line):
            continue
        where = f"{path}:{name}"
        used.add(where)
        if not init and where not in ALLOWED:
            bad.append(f"{path}:{number}: {name}() prints without a limit")


def main():
    bad, used = [], set()
    files = [p for d in sys.argv[1:] for p in sorted(Path(d).rglob("*.[ch]"))]
    for path in files:
        check(path, bad, used)
    bad += [f"{w} is allowed to print but does not; remove it" for w in ALLOWED if w not in used]
    print("\n".join(bad))
    return 1 if bad or not files else 0


sys.exit(main())
