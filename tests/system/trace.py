#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""What a cyclic thread did that it must not do, from a trace of ftrace.

usage: trace.py TRACE COMM [CALL...]

COMM is the name of the thread. Prints "name number" lines:
  cycles      sleeps at the one place where it may sleep
  syscalls    system calls, those that sleep included
  sleeps      sleeps anywhere else: it waited for something
  contended   locks it did not get at once
  faults      page faults
  allocs      allocations of memory
  prints      lines to the console
  device      locks and allocations of the network driver, or of the simulator
              in its place, in the context of the thread; and the wait for
              interrupt work under way on its CPU, which sending may need
  preempted   somebody more urgent ran
CALL: numbers of the system calls it may sleep in, or NUMBER:COMMAND for one
command of ioctl(); without any it is a thread of the kernel, which may sleep
idly, in its one place. Lines with "#" show the first things it must not do.
"""
import re
import sys

LINE = re.compile(r"^\s*(.+)-(\d+)\s+\[\d+\]\s+(\S+)\s+[\d.]+: (\w+)(?:\(|: |:$)(.*)$")
FRAME = re.compile(r"^ => (\S.*)$")
DEVICE = re.compile(r"\[(ec_sim|e1000e)\]|napi_poll|net_[rt]x_action|__local_bh_disable_ip")
SHOWN = 5
NAMES = "cycles syscalls sleeps contended faults allocs prints device preempted"

# events that a cycle must not have
BAD = {
    "kmalloc": "allocs", "kmalloc_node": "allocs", "kmem_cache_alloc": "allocs",
    "kmem_cache_alloc_node": "allocs", "mm_page_alloc": "allocs",
    "page_fault_user": "faults", "page_fault_kernel": "faults",
    "console": "prints", "contention_begin": "contended",
}


class Event:
    def __init__(self, line, m):
        self.line = line.strip()
        self.comm, self.flags, self.name, self.rest = m[1].strip(), m[3], m[4], m[5]
        self.stack = []


def events(lines):
    """Events with the call trace that follows some of them."""
    last = None
    for line in lines:
        frame = FRAME.match(line)
        if frame and last:
            last.stack.append(frame[1])
            continue
        m = LINE.match(line)
        if m:
            if last:
                yield last
            last = Event(line, m)
    if last:
        yield last


class Count:
    def __init__(self, may_sleep):
        self.n = dict.fromkeys(NAMES.split(), 0)
        self.examples = []
        self.may_sleep = may_sleep
        self.call = None  # names of the system call it is in
        self.waits = False  # for a lock, which was counted

    def bad(self, name, e):
        if name in ("contended", "allocs") and any(DEVICE.search(f) for f in e.stack):
            self.n["device"] += 1
            return
        self.n[name] += 1
        if len(self.examples) < SHOWN:
            self.examples.append(e.line + "".join("\n#   " + f for f in e.stack))

    def switch(self, e):
        state = re.search(r"prev_state=(\S+)", e.rest)[1]
        if state.startswith("R"):
            self.n["preempted"] += 1
        elif self.waits:
            pass
        elif self.call and not self.may_sleep.isdisjoint(self.call) or \
                not self.may_sleep and state == "I":
            self.n["cycles"] += 1
        else:
            self.bad("sleeps", e)

    def take(self, e):
        if e.name == "sys_enter":
            nr, second = re.search(r"NR (\d+) \([^,]*, ([^,)]*)", e.line).groups()
            self.call = nr, nr + ":" + second
            self.n["syscalls"] += 1
        elif e.name == "sys_exit":
            self.call = None
        elif e.name == "sched_switch":
            self.switch(e)
        elif e.name == "contention_end":
            self.waits = False
        # a hard interrupt is not the thread's doing
        elif e.name in BAD and e.flags[2:3] not in ("h", "H", "z", "Z"):
            self.waits |= e.name == "contention_begin"
            self.bad(BAD[e.name], e)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    c = Count(set(sys.argv[3:]))
    with open(sys.argv[1], errors="replace") as f:
        for e in events(f):
            if e.comm == sys.argv[2]:
                c.take(e)
    for name, n in c.n.items():
        print(name, n)
    for example in c.examples:
        print("#", example)


main()
