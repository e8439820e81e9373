#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Compares what tshark sees in a capture with what our decoders saw when it
was written (capture.c).

usage: compare.py CAPTURE      for CAPTURE.pcap and CAPTURE.txt
"""
import subprocess
import sys

# one occurrence a datagram, of adp and ado or lad
DATAGRAM = ("cmd", "idx", "adp", "ado", "lad", "subframe.length", "int", "cnt")
LOGICAL = (10, 11, 12)
MAILBOX = {     # ours: theirs
    "type": "type", "len": "length", "address": "address", "counter": "counter",
    "service": "coe.type", "number": "coe.number",
    "index": "coe.sdoidx", "sub": "coe.sdosub", "abort": "coe.abortcode",
    "opcode": "coe.sdoinfoopcode", "left": "coe.sdoinfofrag",
}
OTHER = ["coe.sdoreq", "coe.sdores", "coe.sdoccsds.toggle", "coe.sdoccsus_toggle",
         "coe.sdoscsds_toggle", "coe.sdoscsus_toggle", "invalid", "coe.invalid"]


def tshark(pcap):
    """yields {field: text} for each frame"""
    fields = ["_ws.malformed"]
    fields += ["ecat." + f for f in DATAGRAM]
    fields += ["ecat_mailbox." + f for f in list(MAILBOX.values()) + OTHER]
    cmd = ["tshark", "-r", pcap, "-T", "fields", "-E", "separator=/t",
           "-E", "occurrence=a", "-E", "aggregator=;"]
    for f in fields:
        cmd += ["-e", f]
    out = subprocess.run(cmd, check=True, stdout=subprocess.PIPE,
                         stderr=subprocess.DEVNULL, text=True).stdout
    for line in out.splitlines():
        yield dict(zip(fields, line.split("\t")))


def num(text, base=0):
    """flags are words in newer versions"""
    if text in ("True", "False"):
        return int(text == "True")
    return int(text, base) if text else None


def their_datagrams(t):
    """as ours: (cmd, idx, adp, ado, len, irq, wkc)"""
    v = {f: [num(x) for x in t["ecat." + f].split(";") if x] for f in DATAGRAM}
    result = []
    for cmd in v["cmd"]:
        take = lambda f: v[f].pop(0) if v[f] else None
        if cmd in LOGICAL:
            lad = take("lad")
            address = (lad & 0xffff, lad >> 16)
        else:
            address = (take("adp"), take("ado"))
        result.append((cmd, take("idx"), *address, take("subframe.length"),
                       take("int"), take("cnt")))
    return result


def our_datagrams(text):
    result = []
    for d in text.split("; "):
        f = d.split()
        result.append((int(f[0]), int(f[1]), int(f[2], 16), int(f[3], 16),
                       int(f[4]), int(f[5], 16), int(f[6])))
    return result


def our_mailbox(text):
    v = dict(w.split("=") for w in text.split() if "=" in w)
    base = {"address": 16, "index": 16, "sub": 16, "abort": 16}
    return {k: int(x, base.get(k, 10)) for k, x in v.items()}


def their_mailbox(t, ours):
    v = {k: num(t["ecat_mailbox." + f]) for k, f in MAILBOX.items() if k in ours}
    cs = num(t["ecat_mailbox.coe.sdoreq"])
    if cs is None:
        cs = num(t["ecat_mailbox.coe.sdores"])
    for k in ("cs", "segment"):
        if k in ours:
            v[k] = cs
    if "toggle" in ours:
        toggles = [t["ecat_mailbox." + f] for f in OTHER if f.endswith("toggle")]
        v["toggle"] = num(next((x for x in toggles if x), ""))
    return v


class Verdict:
    def __init__(self):
        self.failures = {}
        self.counts = {}

    def fail(self, check, frame, ours, theirs):
        shown = self.failures.setdefault(check, [])
        shown.append("frame %d: ours %s, tshark %s" % (frame, ours, theirs))

    def count(self, what, n=1):
        self.counts[what] = self.counts.get(what, 0) + n


def check_frame(v, n, line, t):
    text, _, mailbox = line.partition(" | ")
    refused = "refused" in line
    invalid = t["ecat_mailbox.invalid"] or t["ecat_mailbox.coe.invalid"]
    # tshark tries process data of a certain look as a mailbox
    mistaken = not mailbox and bool(t["ecat_mailbox.type"] or invalid)
    if t["_ws.malformed"] and not refused and not mistaken:
        v.fail("malformed", n, line, t["_ws.malformed"])
    if "refused" in text:
        v.count("refused by us, too")
        return
    ours, theirs = our_datagrams(text), their_datagrams(t)
    if ours != theirs:
        v.fail("datagrams", n, ours, theirs)
    v.count("frames")
    v.count("several datagrams", len(ours) > 1)
    for d in ours:
        v.count("cmd %d" % d[0])
    if not mailbox:
        v.count("process data taken for a mailbox", mistaken)
        return
    if refused:
        # tshark does not even take every wrong one for a mailbox
        if t["ecat_mailbox.type"] and not invalid:
            v.fail("malformed", n, line, "sound")
        v.count("refused by us, too")
        return
    if invalid:
        v.fail("malformed", n, line, "invalid mailbox")
    m = our_mailbox(mailbox)
    if m["type"] == 0 and not t["ecat_mailbox.type"]:
        v.count("error replies, unknown to tshark")
    elif m != their_mailbox(t, m):
        v.fail("mailboxes", n, m, their_mailbox(t, m))
    v.count("mailboxes")
    for k in ("type", "service", "segment", "opcode"):
        if k in m:
            v.count("%s %d" % (k, m[k]))
    v.count("aborts", "abort" in m)


def main():
    v = Verdict()
    with open(sys.argv[1] + ".txt") as f:
        lines = f.read().splitlines()
    theirs = list(tshark(sys.argv[1] + ".pcap"))
    if len(lines) != len(theirs):
        v.fail("datagrams", 0, "%d frames" % len(lines), "%d" % len(theirs))
    for n, (line, t) in enumerate(zip(lines, theirs), 1):
        check_frame(v, n, line, t)

    passed = failed = 0
    for check in ("datagrams", "mailboxes", "malformed"):
        bad = v.failures.get(check, [])
        print("%s %s: %d differences" % ("FAIL" if bad else "ok", check, len(bad)))
        for text in bad[:5]:
            print("    " + text)
        failed += bool(bad)
        passed += not bad
    # what must have been there to be compared
    wanted = ["cmd %d" % c for c in range(15)]
    wanted += ["several datagrams", "mailboxes", "aborts", "type 0", "type 3"]
    wanted += ["service %d" % s for s in (1, 2, 3, 8)]
    wanted += ["segment %d" % s for s in (0, 1, 3)]
    wanted += ["opcode %d" % o for o in range(1, 8)]
    for what in wanted:
        n = v.counts.get(what, 0)
        print("%s %s: %d" % ("ok" if n else "FAIL: none with", what, n))
        passed += n > 0
        failed += not n
    for what in ("frames", "refused by us, too", "process data taken for a mailbox",
                 "error replies, unknown to tshark"):
        print("   %s: %d" % (what, v.counts.get(what, 0)))
    print("%d passed, %d failed" % (passed, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
