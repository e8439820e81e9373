# SPDX-License-Identifier: GPL-2.0-only
"""Runs a command in a mount namespace of its own, whose root is that of the guest.

unchroot.py COMMAND...: tests run in a chroot, where no user may have a user namespace.
"""

import ctypes
import os
import sys
import tempfile

CLONE_NEWNS, MS_MOVE, MS_REC, MS_PRIVATE = 0x20000, 0x2000, 0x4000, 0x40000
libc = ctypes.CDLL(None, use_errno=True)


def check(result):
    if result:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


root = tempfile.mkdtemp()
check(libc.unshare(CLONE_NEWNS))
# out of the chroot: the current folder is not below the new root
os.chroot(root)
for _ in range(64):
    os.chdir("..")
os.chroot(".")
check(libc.mount(None, b"/", None, MS_REC | MS_PRIVATE, None))
# as switch_root
os.chdir("/n")
check(libc.mount(b".", b"/", None, MS_MOVE, None))
os.chroot(".")
os.chdir("/")
os.execvp(sys.argv[1], sys.argv[1:])
