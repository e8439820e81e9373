# SPDX-License-Identifier: GPL-2.0-only
"""Reads the kernel-doc comments of a header and writes them as reStructuredText.

The result is that of the kernel's scripts/kernel-doc -rst (tests/build/check.sh compares them), for
what our headers contain: functions, structures and enumerations. So the pages need no headers of a
kernel.
"""
import re

COMMENT = re.compile(r"/\*\*\n(.*?)\*/\n(.*?)(?=\n/\*\*\n|\Z)", re.S)
PLAIN = re.compile(r"/\*.*?\*/", re.S)


def parse(text):
    """Name, summary, parameters, and sections of a comment."""
    lines = [re.sub(r"^ \* ?", "", line.expandtabs()) for line in text.rstrip().split("\n")]
    head = re.match(r"(?:struct |enum )?(\w+)(?:\(\))? - (.*)", lines[0])
    params, sections, now, summary = {}, {}, None, [head[2]]
    while len(lines) > 1 and lines[1].strip() and lines[1][0] != "@":
        summary.append(lines.pop(1).strip())
    for line in lines[1:]:
        param = re.match(r"@(\w+): ?(.*)", line)
        section = re.match(r"(Context|Return): *(.*)", line)
        if param:
            now = params.setdefault(param[1], [])
            line = param[2]
        elif section:
            now = sections.setdefault(section[1], [])
            line = section[2]
        elif not line.strip():
            if now is not sections.get("Description"):
                now = None
        elif now is None:
            now = sections.setdefault("Description", [])
        if now is not None:
            now.append(line.strip() if any(now is p for p in params.values()) else line)
    return head[1], " ".join(summary), params, sections


def marked(text):
    """Constants and parameters in a text as literals and strong words."""
    text = re.sub(r"%([-\w]+)", r"``\1``", text)
    return re.sub(r"@(\w+(?:(?:->|\.)\w+)*)", r"**\1**", text)


def lines_of(text):
    return [marked(line) for line in "\n".join(text).strip("\n").split("\n")]


def split(text):
    """Parameters of a function: those of a callback contain commas."""
    depth, part = 0, ""
    for c in text + ",":
        depth += (c == "(") - (c == ")")
        if c == "," and not depth:
            yield re.sub(r"\s+", " ", part.strip())
            part = ""
        else:
            part += c


def name_of(param):
    found = re.search(r"\(\*(\w+)\)", param) or re.search(r"(\w+)(\[\w*\])?$", param)
    return found[1]


def function(code, summary, params):
    found = re.match(r"([^(]*?)(\w+)\s*\((.*)\);", code, re.S)
    result = re.sub(r"\s+", " ", found[1]).strip()
    args = list(split(found[3]))
    yield f".. c:function:: {result} {found[2]} ({', '.join(args)})"
    yield from ("", f"   {marked(summary)}", "", "**Parameters**", "")
    for arg in args:
        yield f"``{arg}``"
        text = ["no arguments"] if arg == "void" else lines_of(params[name_of(arg)])
        yield from (f"  {line}" for line in text)
        yield ""


def members(kind, code, name, summary, params):
    body = PLAIN.sub("", re.search(r"\{(.*)\}", code, re.S)[1])
    yield from (f".. c:{kind}:: {name}", "", f"   {marked(summary)}", "")
    if kind == "struct":
        yield from ("**Definition**", "", "::", "", f"  struct {name} {{")
        for line in filter(str.strip, body.split(";")):
            text = re.sub(r"\s+", " ", line.strip())
            yield f"    {text};"
        yield from ("  };", "")
    yield from ("**Members**" if kind == "struct" else "**Constants**", "")
    for item in filter(str.strip, re.split("[;,]", body)):
        item = re.search(r"(\w+)(\[\w*\])?$", re.split("[=:]", item)[0].strip())[1]
        yield f"``{item}``"
        yield from (f"  {line}" for line in lines_of(params[item]))
        yield ""


def document(text):
    """Lines of the documentation of a header."""
    for comment, code in COMMENT.findall(re.sub(r"^#if.*\n|^#e.*\n", "", text, flags=re.M)):
        name, summary, params, sections = parse(comment)
        kind = re.match(r"(?:typedef )?(struct|enum)\b", code)
        if kind:
            name = re.search(r"\}\s*(\w+);", code)[1] if "typedef" in kind[0] else name
            yield from members(kind[1], code[:code.index("}") + 1], name, summary, params)
        else:
            yield from function(code[:code.index(";") + 1], summary, params)
        for section in ("Description", "Context", "Return"):
            if section in sections:
                yield from (f"**{section}**", "", *lines_of(sections[section]), "")
        yield ""
