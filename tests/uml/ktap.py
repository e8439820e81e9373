#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Judges the console log of a UML test run; see run.sh."""
import argparse
import os
import re
import sys

TROUBLE = re.compile(
    r"BUG:|WARNING:|\bKASAN\b.*:|Oops|UBSAN:|INFO: (?!lockdep is turned off)"
    r"|possible (circular|recursive|irq)|suspicious RCU|ODEBUG:"
    r"|list_(add|del) corruption|refcount_t:|unreferenced object"
    r"|kmemleak: (?!Automatic memory scanning|Kernel memory leak detector)"
    r"|(sleeping function called|scheduling while atomic)"
    r"|Segfault|general protection|Kernel panic")
# UML has no root file system to go on with: the normal end without
# kunit_shutdown.
NORMAL_END = re.compile(r"Kernel panic.*(Unable to mount root|No working init)")
# Printed before KUnit starts, by the kernel about itself.
BANNER = re.compile(r"kasan: |KernelAddressSanitizer initialized")


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("log")
    ap.add_argument("--seconds", default="0")
    ap.add_argument("--limit", default="?")
    ap.add_argument("--cases", default=os.devnull,
                    help="file for the result of each case")
    a = ap.parse_args()
    with open(a.log, errors="replace") as f:
        lines = [re.sub(r"^\[ *\d+\.\d+\] ", "", x.rstrip("\r\n")) for x in f]

    suites_planned = None
    suites = []                 # [name, passed, failed, skipped]
    cur = None
    cases_planned = 0
    diag = []
    trouble = []
    problems = []
    passed = failed = skipped = 0
    hung = False
    last_seen = "start of the kernel"
    cases = open(a.cases, "w")

    for n, line in enumerate(lines):
        line = line.replace("drivers/ethercat/", "")
        if line == "EC-UML-HANG":
            hung = True
        if (TROUBLE.search(line) and not NORMAL_END.search(line)
                and not BANNER.search(line)):
            trouble.append(n)
        if suites_planned is None:
            m = re.match(r"1\.\.(\d+)$", line)
            if m:
                suites_planned = int(m.group(1))
            continue
        m = re.match(r"    # Subtest: (\S+)", line)
        if m and not line.startswith("     "):
            cur = [m.group(1), 0, 0, 0]
            diag = []
            cases_planned = 0
            last_seen = "suite " + cur[0]
            continue
        m = re.match(r"    1\.\.(\d+)$", line)
        if m:
            cases_planned = int(m.group(1))
            continue
        m = re.match(r"( *)(not ok|ok) \d+ (?:- )?(.*?)(?: # (SKIP.*))?$", line)
        if not m:
            diag.append(line)
            continue
        indent, ok, name, skip = m.groups()
        if len(indent) == 4 and cur:
            last_seen = "%s.%s" % (cur[0], name)
            print("skip" if skip else ok, last_seen, file=cases)
            if ok == "not ok":
                cur[2] += 1
                print("FAIL %s.%s" % (cur[0], name))
                print("\n".join("  | " + d for d in diag))
            elif skip:
                cur[3] += 1
                print("skip %s.%s: %s" % (cur[0], name, skip))
            else:
                cur[1] += 1
            diag = []
        elif not indent and cur:
            ran = cur[1] + cur[2] + cur[3]
            if ok == "not ok" and not cur[2]:
                cur[2] += 1
                print("FAIL %s (suite)" % name)
                print("\n".join("  | " + d for d in diag))
            elif ran < cases_planned:
                problems.append("%s: %d of %d cases ran"
                                % (name, ran, cases_planned))
            print("%-4s %-32s %d passed, %d failed%s"
                  % ("ok" if not cur[2] else "FAIL", name, cur[1], cur[2],
                     ", %d skipped" % cur[3] if cur[3] else ""))
            suites.append(cur)
            cur = None
            diag = []
        elif ok == "not ok":
            diag.append(line)

    if cur:
        suites.append(cur)
    passed = sum(s[1] for s in suites)
    failed = sum(s[2] for s in suites)
    skipped = sum(s[3] for s in suites)
    done = len(suites) - (1 if cur else 0)

    if hung:
        problems.append("hang: stopped after %s s of real time, last: %s"
                        % (a.limit, last_seen))
    elif suites_planned is None:
        problems.append("the kernel did not get as far as KUnit")
    elif done < suites_planned:
        problems.append("crash: %d of %d suites ended, last: %s"
                        % (done, suites_planned, last_seen))
    elif passed + failed + skipped == 0:
        problems.append("no test ran; is the filter right?")
    if suites_planned is None or (not hung and done < (suites_planned or 0)):
        print("\n".join("  | " + x for x in lines[-40:]))

    # The first few reports are the ones worth reading.
    shown = -1
    for n in trouble[:6]:
        if n <= shown:
            continue
        print("KERNEL REPORT at line %d of the log:" % (n + 1))
        shown = min(n + 40, len(lines) - 1)
        for x in lines[max(0, n - 2):shown + 1]:
            # Stale return addresses and raw stack words only hide the trace.
            if not re.search(r"\] \? |^( [0-9a-f]{8}){4}$|^Stack:$", x):
                print("  | " + x.replace("drivers/ethercat/", ""))
    if trouble:
        problems.append("%d kernel warning line(s), see above" % len(trouble))

    for p in problems:
        print("ERROR: " + p)
    print("%.1f s%s" % (float(a.seconds),
                        ", %d skipped" % skipped if skipped else ""))
    print("%d passed, %d failed" % (passed, failed))
    sys.stdout.flush()
    return 1 if failed or problems else 0


if __name__ == "__main__":
    sys.exit(main())
