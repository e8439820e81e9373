#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Every command of README.md, CONTRIBUTING.md, Documentation/ is run by a test or marked.

Takes the literal blocks, and the inline commands that begin with make, ethercat, ethercatctl,
systemctl, ethercat-sim or tests/, also of the page of codes that "make doc" writes. Each must be in
commands.txt, as

    TEST       : TEXT : COMMAND      the file TEST contains TEXT, which runs the command
    level NAME : TEXT : COMMAND      tests/check.sh runs that level by default, with TEXT
    by hand    : WHY  : COMMAND      no test runs it; its script and make target exist
    -          : WHY  : FIRST LINE   the whole block is no command

and each line there must be used. That TEXT runs the command with these words, and that
TEST is run, is not proved here: tests/system/docs.bats reads its commands from the
documents, all other rows are for the reader to follow.

A block that begins with "$ COMMAND" is output: docs.bats has the line "screen FILE '$ COMMAND'",
which compares it with what the command prints now; "..." in it stands for anything. With "like
FILE '$ COMMAND'" the values of numbers do not count.
usage: commands.py [--block FILE FIRST_LINE]    the commands of a block
       commands.py --screen|--like FILE FIRST_LINE      is the output on stdin that of the block?
"""
import difflib
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ("make", "ethercat", "ethercat-sim", "ethercatctl", "systemctl")
INLINE = re.compile(rf"^((\w+=\S+ )*({'|'.join(PROGRAMS)})( |$)|tests/\S+\.sh)")


def blocks(path):
    """Lists of the lines of each literal block; shell continuations are joined."""
    rst = path.suffix == ".rst"
    block, inside, indent = [], not rst, 0
    for line in path.read_text().split("\n") + ["end"]:
        if line.startswith("    ") and inside or (indent and line[:indent].isspace()):
            indent = indent or len(line) - len(line.lstrip())
            block.append(line[indent:])
        elif not line.strip() and (block or inside):
            continue
        else:
            if block:
                yield "\n".join(block).replace("\\\n", "").split("\n")
            block, indent = [], 0
            inside = line.rstrip().endswith("::") if rst else True


def inline(text, mark):
    text = re.sub(r"\s+", " ", text)
    for span in re.findall(mark + "([^`]+)" + mark, text):
        if INLINE.match(span) and span not in PROGRAMS:
            yield span


def command(line):
    return re.sub(r"\s+", " ", re.sub(r"\s{2,}#.*$", "", line)).strip()


def table():
    rows = {}
    for line in (Path(__file__).parent / "commands.txt").read_text().split("\n"):
        if line and not line.startswith("#"):
            test, text, what = line.split(" : ", 2)
            rows[what] = (test, text)
    return rows


def levels():
    """What tests/check.sh runs by default, and the commands of each."""
    text = (ROOT / "tests/check.sh").read_text()
    names = re.search(r'^levels="([^"]*)"', text, re.M)[1].split()
    bodies = dict(re.findall(r"^level_(\w+)\(\) \{ (.*); \}$", text, re.M))
    return {n: bodies.get(n, "") for n in names}


def exists(what):
    """The scripts and make targets in a command."""
    words = [w for w in what.split() if "=" not in w]
    if words[0] == "make" and "-C" not in words:
        makefile = (ROOT / "Makefile").read_text()
        return all(re.search(rf"^([\w -]+ )?{re.escape(w)}( [\w -]+)?:", makefile, re.M)
                   for w in words[1:] if not w.startswith("-"))
    return all((ROOT / w).exists() for w in words if w.startswith("tests/"))


def wrong(what, test, text, run):
    """What a row claims and is not so, or None."""
    if test == "-":
        return None
    if not exists(what):
        return "names a script or target that is not there"
    if test == "by hand":
        return None if text else "says not why"
    if test.startswith("level "):
        if test[6:] not in run:
            return f"tests/check.sh runs no {test} by default"
        return None if text in run[test[6:]] else f"{test} has no '{text}'"
    return None if text in (ROOT / test).read_text() else f"{test} has no '{text}'"


def show(path, first):
    """The commands of one block, for tests/system/docs.bats."""
    for block in blocks(ROOT / path):
        if command(block[0]) == first:
            print("\n".join(filter(None, map(command, block))))
            return 0
    return 1


def folded(line):
    """A line without the values of its numbers, which also change its blanks."""
    number = r"(?<![\w.])[-+]?(0x)?[0-9a-f]*[0-9.+][0-9a-f.+:]*(?![\w])|\b[0-9a-f]{2}\b"
    return re.sub(r"\s+", " ", re.sub(number, "#", line))


def screen(fold, path, first):
    """Does stdin equal a block, but for its first line and for "..."?"""
    printed = [fold(line.rstrip()) for line in sys.stdin.read().rstrip("\n").split("\n")]
    for block in blocks(ROOT / path):
        if block[0] == first:
            block = [line if line == "..." else "...".join(map(fold, line.rstrip().split("...")))
                     for line in block[1:]]
            pattern = "".join("(?:.*\n)*?" if line == "..." else
                              ".*".join(map(re.escape, line.split("..."))) + "\n"
                              for line in block)
            if re.fullmatch(pattern, "\n".join(printed) + "\n"):
                return 0
            print("\n".join(difflib.unified_diff(block, printed, path, "printed", lineterm="")))
            return 1
    print(f"{path} has no block '{first}'")
    return 1


def codes():
    """What "make doc" writes about codes, without the tables around it."""
    page = ROOT / "Documentation/sphinx/codes.py"
    return subprocess.run([page, ROOT, "--remedies"], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


def main():
    if sys.argv[1:2] == ["--block"]:
        return show(*sys.argv[2:])
    if sys.argv[1:2] in (["--screen"], ["--like"]):
        return screen(folded if sys.argv[1] == "--like" else str, *sys.argv[2:])
    rows, used, bad, count = table(), set(), [], 0
    shown = (ROOT / "tests/system/docs.bats").read_text()

    def look(where, what):
        nonlocal count
        count += 1
        if what not in rows:
            bad.append(f"{where}: no test runs '{what}' (tests/build/commands.txt)")
            return
        used.add(what)

    documents = [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
    for path in documents + sorted((ROOT / "Documentation").glob("*.rst")):
        name = path.relative_to(ROOT)
        for block in blocks(path):
            first = block[0].strip()
            if rows.get(first, ("",))[0] == "-":
                used.add(first)
                continue
            if first.startswith("$ "):
                count += 1
                test = rf"\b(screen|like) {name}[\s\\]+['\"]{re.escape(first)}['\"]"
                if not re.search(test, shown):
                    bad.append(f"{name}: docs.bats has no: screen {name} '{first}'")
                continue
            for line in block:
                if command(line):
                    look(name, command(line))
        for span in inline(path.read_text(), "``" if path.suffix == ".rst" else "`"):
            look(name, command(span))
    for span in inline(codes(), "``"):
        look("codes.py", command(span))
    run = levels()
    for what, (test, text) in rows.items():
        if what not in used:
            bad.append(f"commands.txt: '{what}' is in no document")
        elif wrong(what, test, text, run):
            bad.append(f"commands.txt: '{what}': {wrong(what, test, text, run)}")
    print("\n".join(bad))
    hand = sum(test == "by hand" for test, _ in rows.values())
    print(f"{count} commands, {hand} of them by hand")
    return 1 if bad or not count else 0


if __name__ == "__main__":
    sys.exit(main())
