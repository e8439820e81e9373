#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Start another kernel at once, as "systemctl kexec" does at its end; needs root, x86-64.

usage: kexec.py KERNEL COMMAND_LINE
"""
import ctypes
import os
import sys

KEXEC_FILE_LOAD, KEXEC_FILE_NO_INITRAMFS = 320, 4
REBOOT, MAGIC, MAGIC2, CMD_KEXEC = 169, 0xfee1dead, 672274793, 0x45584543

libc = ctypes.CDLL(None, use_errno=True)
line = sys.argv[2].encode() + b"\0"
kernel = os.open(sys.argv[1], os.O_RDONLY)
if libc.syscall(KEXEC_FILE_LOAD, kernel, -1, ctypes.c_long(len(line)), line,
                ctypes.c_long(KEXEC_FILE_NO_INITRAMFS)) < 0:
    sys.exit(f"kexec_file_load: {os.strerror(ctypes.get_errno())}")
if libc.syscall(REBOOT, ctypes.c_long(MAGIC), ctypes.c_long(MAGIC2), ctypes.c_long(CMD_KEXEC),
                None) < 0:
    sys.exit(f"reboot: {os.strerror(ctypes.get_errno())}")
