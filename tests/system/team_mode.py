#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Set the mode of a team device, by generic netlink (linux/if_team.h).

usage: team_mode.py DEVICE MODE
"""
import errno
import os
import socket
import struct
import sys

GENL_ID_CTRL, CTRL_CMD_GETFAMILY, CTRL_ATTR_FAMILY_ID, CTRL_ATTR_FAMILY_NAME = 16, 3, 1, 2
TEAM_CMD_OPTIONS_SET = 1
TEAM_ATTR_TEAM_IFINDEX, TEAM_ATTR_LIST_OPTION, TEAM_ATTR_ITEM_OPTION = 1, 2, 1
OPTION_NAME, OPTION_TYPE, OPTION_DATA = 1, 3, 4
NLA_STRING, NLA_F_NESTED = 5, 0x8000
NLM_F_REQUEST, NLM_F_ACK, NLMSG_ERROR = 1, 4, 2


def attr(kind, data):
    head = struct.pack("HH", 4 + len(data), kind)
    return head + data + bytes(-len(data) % 4)


def ask(sock, family, cmd, attrs):
    body = struct.pack("BBH", cmd, 1, 0) + attrs
    sock.send(struct.pack("IHHII", 16 + len(body), family, NLM_F_REQUEST | NLM_F_ACK, 1, 0) + body)
    answer = b""
    while True:
        data = sock.recv(65536)
        kind = struct.unpack_from("H", data, 4)[0]
        if kind != NLMSG_ERROR:
            answer = data[20:]
            continue
        error = struct.unpack_from("i", data, 16)[0]
        # the team tells its listeners of the change; without any it returns this
        if error and error != -errno.ESRCH:
            sys.exit(f"command {cmd}: {os.strerror(-error)}")
        return answer


def family_id(sock, name):
    data = ask(sock, GENL_ID_CTRL, CTRL_CMD_GETFAMILY,
               attr(CTRL_ATTR_FAMILY_NAME, name.encode() + b"\0"))
    while data:
        length, kind = struct.unpack_from("HH", data)
        if kind == CTRL_ATTR_FAMILY_ID:
            return struct.unpack_from("H", data, 4)[0]
        data = data[(length + 3) & ~3:]
    sys.exit(f"no family {name}")


def main():
    device, mode = sys.argv[1:]
    sock = socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, 16)
    sock.bind((0, 0))
    option = (attr(OPTION_NAME, b"mode\0") + attr(OPTION_TYPE, bytes([NLA_STRING])) +
              attr(OPTION_DATA, mode.encode() + b"\0"))
    ask(sock, family_id(sock, "team"), TEAM_CMD_OPTIONS_SET,
        attr(TEAM_ATTR_TEAM_IFINDEX, struct.pack("I", socket.if_nametoindex(device))) +
        attr(TEAM_ATTR_LIST_OPTION | NLA_F_NESTED,
             attr(TEAM_ATTR_ITEM_OPTION | NLA_F_NESTED, option)))


main()
