#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Texts that a user reads use the terms of the glossary.

Looks at README.md, CONTRIBUTING.md, Documentation/, the interfaces in include/ and the comments of
examples, the manual page, and the strings of master, devices, library, tool and examples (log
lines, reasons, output, help) for wordings that were replaced.

A second pass reads the comments alone of the folders in COMMENTS, where hits are limited. A
comment of any source names only a page that exists: it cites a clause of ETG.1000, or
Documentation/. A page names only functions and structures that a source has.
usage: texts.py [FILE...]      default: all of them
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent

# wording (a regular expression for whole words, any case): write instead
WORDINGS = {
    r"told|tells?|telling": "configured, reported; reports, shows, returns",
    r"odd": "inconsistent; of a delay: unreliable",
    r"make no sense|do(es)? not fit together": "inconsistent",
    r"in vain": "failed attempt",
    r"that cannot be": "invalid",
    r"the field'?s?( standard| community)?": "IgH EtherCAT Master",
    r"the original('s)?": "IgH EtherCAT Master",
    r"speaks?|talks? to": "interface version not supported; accesses",
    r"who|whom|whoever|whose turn": "the caller, the application: name the noun",
    r"somebody|someone|nobody|anybody|everybody": "name the noun; no ...",
    r"he|him": "name the noun",
    r"follows us|as it should": "say what is synchronized to what",
    r"in step": "synchronized, inside the sync window",
    r"dies|died|death": "exits, releases the master",
    r"(is|are|has|have) gone": "exited; detached, disconnected; freed",
    r"outlived": "detached session",
    r"falls? back|fell back": "leaves OP without request",
    r"takes? back|took back|takes the links": "ends cyclic bus access",
    r"owner of the links|idle links": "bus access: direct or cyclic",
    r"cyclic caller of": "cycle owner",
    r"left out": "skipped, excluded, omitted",
    r"made late|make (a |no )?cycles? late|late cycles?": "delayed cycle",
    r"does not send|sends again": "cycle timeout, cycle resumed",
    r"goes on|go on": "continues",
    r"stands? in for": "substitutes",
    r"in front of": "upstream of",
    r"at first|to begin with": "initial, initially",
    r"anew": "again",
    r"looks? (at|into|whether|after)|looked (at|into)": "polls, reads",
    r"want of room|make room|makes room|room for|for room": "buffer size, free wire time, re-arms",
    r"heir": "candidate session",
    r"lanes?": "request queue",
    r"shall": "must; or an imperative",
    r"sync managers?": "SyncManager",
    r"comparisons?": "drift compensation datagram",
    r"stays that|has just appeared": "attached since activation; not attached yet",
    r"come near|comes near": "clocks synchronized",
    r"says? so": "reports it",
    r"synchronis\w*|licence": "American spelling: synchronize, license",
    r"too(?=[.;:)])": "no trailing 'too'",
    r"all the same(?! time)": "nevertheless",
    r"com(e|es|ing) back|came back|(is|are) back(?! in)": "returns, is received; reply",
    r"take part|takes (no )?part|took (no )?part": "processes the datagram, responds",
    r"give up|gives up|gave up|given up": "failed attempt; ends its wait",
    r"(is|are|was|were) there": "is present, exists, is connected",
    r"(is|are|was|were) not there": "is absent, missing",
    r"for ever": "forever",
    r"hand(s|ed)? (over|it)": "passes, starts",
    r"on (its|their) way": "in flight; in INIT; not yet in OP",
    r"lives?( in)?|lived": "is in, exists",
    r"as (it|they) (is|are|was|were)": "unchanged, current",
    r"whatever|however (often|rarely)": "any; in any case",
    r"(a|the) want of": "missing",
    r"cyclic caller|run(s|ning)? the links": "cycle owner",
}

# a fixed interface, or a quotation: file, wording as found
ALLOWED = {
    ("tool/cmd_cycle.c", "nobody"): "a JSON value",
    ("tool/cycle_text.c", "nobody"): "a JSON value",
    ("tool/ethercat.8", "nobody"): "a JSON value",
    ("include/uapi/ethercat_map.h", "odd"): "an odd number",
    ("tool/sim/main.c", "tell"): "an option",
}

# folder: hits that are left in its comments. They only go down
COMMENTS = {
    "lib": 0,
    "lib/bus": 0,
    "lib/ecrt": 0,
    "lib/tools": 0,
    "master": 0,
    "master/base": 0,
    "master/boundary": 0,
    "master/bus": 0,
    "master/carry": 0,
    "master/clock": 0,
    "master/config": 0,
    "master/cycle": 0,
    "master/kernel": 0,
    "master/link": 0,
    "master/mailbox": 0,
    "master/session": 0,
    "master/wire": 0,
    "tool": 0,
    "tool/sim": 0,
}
SOURCES = ("master", "devices", "lib", "tool", "include", "examples", "tests")
NAME = re.compile(r"\b(?:ec|ecdev|ecrt|ect)_\w+\b(?![*.<])")
OF_IGH = {"ec_foe_error_t"}
PAGE = re.compile(r"[\w./-]*\w\.(?:md|rst)\b")

STRING = re.compile(r'"((?:\\.|[^"\\\n])*)"')
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)


TOKEN = re.compile(r"%s|%s|'(?:\\.|[^'\\\n])*'" % (COMMENT.pattern, STRING.pattern), re.S)


def words(pattern):
    return re.compile(r"(?<![\w'-])(?:%s)(?![\w-])" % pattern, re.I)


def blank(text):
    """@text without its words, the lines kept"""
    return re.sub(r"[^\n]", " ", text)


def strings(text):
    """only what stands in quotation marks, each at its place; adjacent strings are one text"""
    text = COMMENT.sub(lambda m: blank(m.group()), text)
    text = re.sub(r"^\s*#.*$", lambda m: blank(m.group()), text, flags=re.M)
    text = re.sub(r"'(\\.|[^'\\])'", lambda m: " " * len(m.group()), text)
    out, end = [], 0
    for m in STRING.finditer(text):
        between = text[end:m.start()]
        out.append(blank(between) if not between.strip() else re.sub(r"[^\n]", ".", between))
        out.append(" " + re.sub(r"\\n", ". ", m.group(1)) + " ")
        end = m.end()
    return "".join(out)


def comments(text):
    """only the comments, each at its place, without the stars at the left and @names"""
    out, end = [], 0
    for m in TOKEN.finditer(text):
        found = m.group() if m.group()[0] == "/" else blank(m.group())
        out.append(blank(text[end:m.start()]))
        out.append(re.sub(r"(?m)^\s*\*(?!/)|@\w+", lambda s: blank(s.group()), found))
        end = m.end()
    return "".join(out)


def corpus():
    yield ROOT / "README.md"
    yield ROOT / "CONTRIBUTING.md"
    yield from sorted((ROOT / "Documentation").glob("*.rst"))
    yield from sorted((ROOT / "include").rglob("*.h"))
    yield ROOT / "tool/ethercat.8"
    for folder in ("master", "devices", "lib", "tool", "examples"):
        for path in sorted((ROOT / folder).rglob("*.[ch]")):
            if "build" not in path.parts:
                yield path


def readable(path):
    text = path.read_text()
    if path.is_relative_to(ROOT / "examples") or path.is_relative_to(ROOT / "include"):
        text = re.sub(r'"[^"\n]*\.h"', lambda m: blank(m.group()), text)
    elif path.suffix in (".c", ".h"):
        return strings(text)
    # names of functions, files and faults are no prose
    text = re.sub(r"``[^`]*``|`[^`\n]*`", lambda m: blank(m.group()), text)
    if path.suffix == ".rst":
        text = re.sub(r"(?<=::\n)\n(?:(?: [^\n]*)?\n)+", lambda m: blank(m.group()), text)
    return text.replace("\n * ", "\n   ")


def sources():
    for folder in SOURCES:
        for path in sorted((ROOT / folder).rglob("*.[ch]")):
            if "build" not in path.parts:
                yield path


def name_of(path):
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


PATTERNS = [(words(p), instead) for p, instead in WORDINGS.items()]


def hits(name, text, used):
    for pattern, instead in PATTERNS:
        for m in pattern.finditer(text):
            found = " ".join(m.group().split())
            if (name, found.lower()) in ALLOWED:
                used.add((name, found.lower()))
                continue
            yield f"{name}:{text.count(chr(10), 0, m.start()) + 1}: '{found}'; write: {instead}"


def missing_pages(path, text):
    for m in PAGE.finditer(text):
        if not any((where / m.group()).exists()
                   for where in (ROOT, ROOT / "Documentation", path.parent)):
            yield (f"{name_of(path)}:{text.count(chr(10), 0, m.start()) + 1}: no file "
                   f"{m.group()}; write: a clause of ETG.1000, or a page of Documentation/")


def check_comments(paths, used, whole):
    """what is wrong in comments, and is above the limit of its folder"""
    bad, by_folder = [], {}
    for path in paths:
        text = comments(path.read_text())
        bad += missing_pages(path, text)
        folder = name_of(path.parent)
        if folder in COMMENTS or not path.is_relative_to(ROOT):
            by_folder.setdefault(folder, []).extend(hits(name_of(path), text, used))
    for folder, found in by_folder.items():
        limit = COMMENTS.get(folder, 0)
        if len(found) > limit:
            bad += found + [f"{folder}: {len(found)} hits in comments, limit {limit}"]
        elif whole and len(found) < limit:
            bad.append(f"{folder}: lower the limit of hits in comments to {len(found)}")
    return bad


def missing_names(paths):
    """names in pages that no source has, each in literal text"""
    known = {w for path in sources() for w in re.findall(r"\w+", path.read_text())}
    for path in paths:
        text = path.read_text()
        for m in re.finditer(r"``[^`]*``", text):
            for name in NAME.findall(m.group()):
                if name not in known and name not in OF_IGH:
                    yield (f"{name_of(path)}:{text.count(chr(10), 0, m.start()) + 1}: no source "
                           f"has {name}")


def main():
    args = [Path(a).resolve() for a in sys.argv[1:]]
    bad, used, count = [], set(), 0
    for path in args or corpus():
        count += 1
        bad += hits(name_of(path), readable(path), used)
    bad += check_comments([p for p in args or sources() if p.suffix in (".c", ".h")], used,
                          not args)
    bad += missing_names([p for p in args or corpus() if p.suffix == ".rst"])
    if not args:
        bad += [f"{name}: '{found}' is allowed but not there" for name, found in ALLOWED
                if (name, found) not in used]
    print("\n".join(sorted(bad)) or f"{count} files")
    return 1 if bad or not count else 0


sys.exit(main())
