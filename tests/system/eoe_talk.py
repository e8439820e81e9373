# SPDX-License-Identifier: GPL-2.0-only
"""Talks by TCP.

eoe_talk.py page IP		prints what port 80 answers
eoe_talk.py echo IP BYTES	sends random bytes to port 7, and compares what comes back
eoe_talk.py serve		the other end of echo
"""

import os
import socket
import sys
import threading


def connect(ip, port):
    s = socket.create_connection((ip, port), 30)
    s.settimeout(60)
    return s


def read(s):
    data = b""
    while True:
        part = s.recv(65536)
        if not part:
            return data
        data += part


def page(ip):
    s = connect(ip, 80)
    s.sendall(b"GET / HTTP/1.0\r\n\r\n")
    print(read(s).decode().replace("\r", ""), end="")


def echo(ip, count):
    s, data = connect(ip, 7), os.urandom(int(count))

    def send():
        s.sendall(data)
        s.shutdown(socket.SHUT_WR)

    thread = threading.Thread(target=send)
    thread.start()
    back = read(s)
    thread.join()
    print(f"{len(back)} bytes came back" if back == data else f"{len(back)} other bytes came back")


def serve():
    s = socket.create_server(("", 7), family=socket.AF_INET6, dualstack_ipv6=True)
    while True:
        peer = s.accept()[0]
        while True:
            data = peer.recv(65536)
            if not data:
                break
            peer.sendall(data)
        peer.close()


{"page": page, "echo": echo, "serve": serve}[sys.argv[1]](*sys.argv[2:])
