#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""The rows of ETG.1500 (rows.txt) with the tests that prove them.

  rows.py check                every named test exists, every change can be made
  rows.py table FOLDER         table and sum, with the results of a run: FOLDER has uml.cases
                               (EC_UML_CASES of tests/uml/run.sh) and the output of the levels
                               "system" and "tool" with NAME.end, their exit status
  rows.py page                 the page of the documentation
  rows.py chosen N SEED        numbers of N rows, others for another SEED; 0: all that have a change
  rows.py over FOLDER ROW...   sources for EC_UML_OVER of tests/uml/build.sh: a kernel that is
                               started with ec_lacks=ROW lacks the function of that row
  rows.py cases ROW            its tests that run in UML

EC_ROWS: another file than rows.txt
"""
import glob
import hashlib
import os
import re
import sys
import textwrap

TOP = os.path.realpath(os.path.join(os.path.dirname(__file__), "../.."))
FILE = os.environ.get("EC_ROWS") or os.path.join(TOP, "tests/class-a/rows.txt")
# the rows of ETG.1500
NUMBERS = [101, 102, 103, 104, 105, 106, 107, 108, 201, 202, 203, 301, 302, 303, 304, 305,
           401, 402, 403, 404, 501, 502, 503, 504, 505, 506, 601, 602, 603, 701, 702, 703,
           801, 901, 1001, 1101, 1102, 1103, 1201, 1301]
CLASSES = {"shall": "shall", "if": "shall, if used", "should": "should", "may": "may"}
STATES = ["there", "partly", "not there"]
PARAMETER = """// SPDX-License-Identifier: GPL-2.0-only
/* Written by tests/class-a/rows.py: the row of ETG.1500 whose function this kernel lacks */
#include <linux/moduleparam.h>

extern int ec_lacks;
int ec_lacks;
core_param(ec_lacks, ec_lacks, int, 0);
"""


class Row:
    def __init__(self, number, name):
        self.number, self.name = number, name
        self.demand = self.state = self.note = ""
        self.tests, self.also, self.changes = [], [], []


def read_rows(path):
    """The rows of the file, and what is wrong with its form."""
    rows, bad = [], []
    with open(path) as f:
        lines = f.read().split("\n")
    for n, line in enumerate(lines, 1):
        word, _, rest = line.partition(" ")
        rest = rest.strip()
        row = rows[-1] if rows else None
        if not line or line.startswith("#"):
            continue
        if word.isdigit():
            rows.append(Row(int(word), rest))
        elif not row:
            bad.append("line %d: no row yet" % n)
        elif word == "class" and rest in CLASSES:
            row.demand = rest
        elif word == "state":
            row.state, _, row.note = rest.partition(": ")
        elif word == "test":
            row.tests.append(rest)
        elif word == "also":
            row.also.append(rest)
        elif word == "change":
            row.changes.append([rest, "", ""])
        elif word in "-+" and row.changes:
            row.changes[-1]["-+".index(word) + 1] += rest + "\n"
        else:
            bad.append("line %d: '%s' is not known" % (n, line))
    return rows, bad


def kunit_cases():
    """suite.case of all KUnit suites"""
    found = set()
    for path in glob.glob(os.path.join(TOP, "tests/*/*_kunit.c")):
        with open(path) as f:
            text = f.read()
        lists = {name: re.findall(r"KUNIT_CASE\w*\((\w+)", body) for name, body in
                 re.findall(r"struct kunit_case (\w+)\[\] = \{(.*?)\n\};", text, re.S)}
        for body in re.findall(r"struct kunit_suite \w+ = \{(.*?)\};", text, re.S):
            suite = re.search(r'\.name = "(\w+)"', body).group(1)
            cases = re.search(r"\.test_cases = (\w+)", body).group(1)
            found.update("%s.%s" % (suite, c) for c in lists[cases])
    return found


def bats_cases():
    """FILE: NAME of all tests of bats files"""
    found = set()
    for path in glob.glob(os.path.join(TOP, "tests/*/*.bats")):
        with open(path) as f:
            found.update("%s: %s" % (os.path.relpath(path, TOP), name)
                         for name in re.findall(r'^@test "(.*)" \{$', f.read(), re.M))
    return found


def pattern(text):
    """of this text with any white space"""
    return re.compile(r"\s+".join(re.escape(w) for w in text.split()))


def made(text, row, old, new):
    """The source with a change."""
    new = re.sub(r"\bLACKS\b", "(ec_lacks == %d)" % row.number, new.strip())
    text, n = pattern(old).subn(lambda m: new, text)
    if n != 1:
        sys.exit("row %d: %d times: %s" % (row.number, n, old.strip()))
    return text


def change_errors(row):
    for path, old, new in row.changes:
        full = os.path.join(TOP, path)
        if not (path.endswith(".c") and path.startswith(("master/", "lib/ecrt/"))
                and os.path.isfile(full)):
            yield "%s: no source of the master" % path
            continue
        with open(full) as f:
            n = len(pattern(old).findall(f.read())) if old.strip() else 0
        if n != 1:
            yield "%s has %d times: %s" % (path, n, " ".join(old.split()))
        if not re.search(r"\bLACKS\b", new):
            yield "%s: the new text has no LACKS" % path


def row_errors(row, kunit, bats):
    """What is wrong with a row."""
    if row.demand not in CLASSES:
        yield "no class"
    if row.state not in STATES:
        yield "no state: %s" % ", ".join(STATES)
    if row.state in STATES[1:] and not row.note:
        yield "'%s' without a reason" % row.state
    proof = row.state != "not there"
    if proof and not row.tests:
        yield "is said to be there and has no test"
    if not proof and (row.tests or row.also):
        yield "is said to be not there and has tests"
    if bool(row.tests) != bool(row.changes):
        yield "tests and a change that makes them fail belong together"
    for t in row.tests:
        if t not in kunit:
            yield "no test %s" % t
    for t in row.also:
        if t not in kunit and t not in bats:
            yield "no test %s" % t
    yield from change_errors(row)


def all_errors(rows, bad):
    kunit, bats = kunit_cases(), bats_cases()
    numbers = [r.number for r in rows]
    if numbers != NUMBERS:
        bad.append("rows missing: %s; unknown or in another order: %s" % (
            sorted(set(NUMBERS) - set(numbers)),
            [n for i, n in enumerate(numbers) if n not in NUMBERS or n in numbers[:i]]))
    for r in rows:
        bad += ["row %d: %s" % (r.number, e) for e in row_errors(r, kunit, bats)]
    return bad


def level_results(folder):
    """{test: "passed", "failed" or "skipped"} and the levels that ran"""
    results, ran = {}, {}
    words = {"ok": "passed", "not ok": "failed", "skip": "skipped"}
    for level in ("uml", "system", "tool"):
        path = os.path.join(folder, level + ".end")
        if os.path.exists(path):
            with open(path) as f:
                ran[level] = f.read().split()[0] == "0"
    if "uml" in ran and os.path.exists(os.path.join(folder, "uml.cases")):
        with open(os.path.join(folder, "uml.cases")) as f:
            for line in f:
                word, _, case = line.rstrip("\n").rpartition(" ")
                results[case] = words[word]
    for level in {"system", "tool"} & set(ran):
        with open(os.path.join(folder, level), errors="replace") as f:
            bats_results(results, level, f.read())
    return results, ran


def bats_results(results, level, text):
    """A guest prints each case below the name of its file; the level "tool" prints failures."""
    path = None
    for line in text.split("\n"):
        m = re.match(r"# (tests/\S+\.bats)$", line)
        if m:
            path = m.group(1)
        m = re.match(r"(ok|not ok) \d+ (.*?)( # skip.*)?$", line)
        if m and (path or level == "tool"):
            name = "%s: %s" % (path, m.group(2)) if level == "system" else m.group(2)
            results[name] = ("failed" if m.group(1) != "ok" else
                             "skipped" if m.group(3) else "passed")


def result(test, results, ran):
    """of one test in this run"""
    path, _, name = test.partition(": ")
    level = path.split("/")[1] if name else "uml"
    if level not in ran:
        return "not run"
    if level == "tool":
        return results.get(name) or ("passed" if ran[level] else "no result")
    return results.get(test, "no result")


def table(rows, folder):
    """Prints it; number of rows whose tests have passed, and of others"""
    results, ran = level_results(folder)
    found, failed = {}, []
    print("class A of ETG.1500: row, function, demand, state, tests and their results")
    for r in rows:
        print("%4d  %-46s %-15s %s" % (r.number, r.name, CLASSES[r.demand],
                                       r.state + (": " + r.note if r.note else "")))
        for t in r.tests + r.also:
            is_ = result(t, results, ran)
            found[t] = is_
            print("      %-9s %s" % (is_, t))
            if is_ not in ("passed", "not run"):
                failed.append("not ok - class A: row %d: %s: %s" % (r.number, is_, t))
    by = lambda s: [r for r in rows if r.state == s]
    of = lambda some: ", ".join("%s %d of %d" % (
        word, sum(r.demand in demands for r in some), sum(r.demand in demands for r in rows))
        for word, demands in (("shall", ("shall", "if")), ("should", ("should",)),
                              ("may", ("may",))))
    print("class A of ETG.1500: %d rows: %d there (%s), %d partly, %d not there; tests: %s" % (
        len(rows), len(by("there")), of(by("there")), len(by("partly")), len(by("not there")),
        ", ".join("%d %s" % (list(found.values()).count(k), k)
                  for k in sorted(set(found.values())))))
    for line in failed:
        print(line)
    bad = {line.split(":")[1] for line in failed}
    return sum(bool(r.tests) for r in rows) - len(bad), len(bad)


PAGE = """.. SPDX-License-Identifier: GPL-2.0-only
.. Written by tests/class-a/rows.py page, from tests/class-a/rows.txt

==========================
Class A of ETG.1500
==========================

ETG.1500 lists what a master of class A ``shall``, ``should`` and ``may`` have; with *if used* a row
holds for a master that has the function at all. ``tests/class-a/rows.txt`` has for each row what
this master has, the tests that prove it, and the change of the source that takes the function away.
``make check`` prints the table with the results of its run; it fails when a test is missing or
fails. It also makes the changes of some rows, others for each commit, and fails when a test of
these rows passes then. ``make check-long`` does that with all rows.

The tests run against the simulated segment. No test house has tested this master.

"""


def title(text, line):
    return "%s\n%s\n\n" % (text, line * len(text))


def page(rows):
    out = PAGE.replace("=" * 26, "=" * len("Class A of ETG.1500"))
    width = max(len(r.name) for r in rows)
    rule = "====  %s  ==================  =========\n" % ("=" * width)
    out += rule + "Row   %-*s  %-18s  State\n" % (width, "Function", "Demand") + rule
    for r in rows:
        demand = re.sub(r"^(\w+)", r"``\1``", CLASSES[r.demand])
        out += "%-4d  %-*s  %-18s  %s\n" % (r.number, width, r.name, demand, r.state)
    out += rule + "\n"
    missing = [r for r in rows if r.note]
    if missing:
        out += title("Rows with a remark", "=")
        for r in missing:
            out += textwrap.fill("- %d, %s: %s." % (r.number, r.name, r.note), 99,
                                 subsequent_indent="  ") + "\n"
        out += "\n"
    out += title("Tests", "=")
    out += ("A name with a dot is a KUnit case of ``tests/bus`` or ``tests/unit``, other names are "
            "those of bats\nfiles. Each test fails without the function, but for those with "
            "*also*, for which that is not tried.\n\n")
    for r in rows:
        if r.tests:
            out += "%d, %s\n" % (r.number, r.name)
            out += "".join("  | ``%s``\n" % t for t in r.tests)
            out += "".join("  | also ``%s``\n" % t.replace(": ", "``\n    ``", 1)
                           for t in r.also) + "\n"
    return out.rstrip("\n") + "\n"


def write_over(folder, rows):
    """Only what differs is written, so that make builds no more than that."""
    texts = {"master/lacks.c": PARAMETER}
    for r in rows:
        for path, old, new in r.changes:
            if path not in texts:
                with open(os.path.join(TOP, path)) as f:
                    texts[path] = "extern int ec_lacks;\n#line 1\n" + f.read()
            texts[path] = made(texts[path], r, old, new)
    for full in glob.glob(os.path.join(folder, "**/*.c"), recursive=True):
        if os.path.relpath(full, folder) not in texts:
            os.unlink(full)
    for path, text in texts.items():
        full = os.path.join(folder, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        if not os.path.exists(full) or open(full).read() != text:
            with open(full, "w") as f:
                f.write(text)


def chosen(rows, n, seed):
    able = [r.number for r in rows if r.changes]
    order = sorted(able, key=lambda k: hashlib.sha256(("%s %d" % (seed, k)).encode()).digest())
    return sorted(order[:n] if n else able)


def main():
    what, args = (sys.argv[1:2] or [""])[0], sys.argv[2:]
    rows, bad = read_rows(FILE)
    pick = lambda numbers: [r for r in rows if str(r.number) in numbers]
    if what == "check":
        bad = all_errors(rows, bad)
        for b in bad:
            print("not ok - class A: " + b)
        print("%d passed, %d failed" % (len(rows) if not bad else 0, len(bad)))
        return 1 if bad else 0
    if bad:
        sys.exit("\n".join(bad))
    if what == "table":
        good, failed = table(rows, args[0])
        print("%d passed, %d failed" % (good, failed))
        return 1 if failed else 0
    if what == "page":
        sys.stdout.write(page(rows))
    elif what == "chosen":
        print(*chosen(rows, int(args[0]), args[1]))
    elif what == "over":
        write_over(args[0], pick(args[1:]))
    elif what == "cases":
        print("\n".join(t for r in pick(args) for t in r.tests))
    else:
        sys.exit(__doc__)
    return 0


if __name__ == "__main__":
    sys.exit(main())
