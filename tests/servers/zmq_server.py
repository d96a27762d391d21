"""A ZeroMQ REP server that behaves well or badly, as the message's text asks.

echo:...  sends the message back
slow      answers after 1 s
never     never answers
huge      answers with 2 MiB
parts     answers in two parts
With the argument `raw` it is no ZeroMQ server: it sends HTTP to whoever connects; with `silent`
it accepts and says nothing; with `flood` it speaks ZMTP 3.0 and answers in parts without an end,
which ZeroMQ itself would keep until the last. With a number it listens at that port.
"""
import os
import socket
import struct
import sys
import time

import zmq


def serve_raw(text):
    listener = socket.create_server(("127.0.0.1", 0))
    print("port", listener.getsockname()[1], flush=True)
    os.close(1)
    kept = []
    while True:
        kept.append(listener.accept()[0])
        kept[-1].sendall(text)
        if text:
            kept.pop().close()


def serve_flood():
    listener = socket.create_server(("127.0.0.1", 0))
    print("port", listener.getsockname()[1], flush=True)
    os.close(1)
    connection = listener.accept()[0]
    connection.sendall(b"\xff" + bytes(8) + b"\x7f\x03\x00NULL" + bytes(48))
    got = b""
    while len(got) < 64:
        got += connection.recv(64 - len(got))
    ready = b"\x05READY\x0bSocket-Type" + struct.pack(">I", 3) + b"REP"
    connection.sendall(bytes([4, len(ready)]) + ready)
    connection.recv(65536)
    try:
        connection.sendall(b"\x01\x00")
        while True:
            connection.sendall(b"\x01\x01x" * 10000)
    except OSError:
        pass


def main():
    if len(sys.argv) > 1 and sys.argv[1] == "flood":
        return serve_flood()
    port = sys.argv[1] if len(sys.argv) > 1 and sys.argv[1].isdigit() else None
    if len(sys.argv) > 1 and port is None:
        serve_raw(b"HTTP/1.1 400 Bad Request\r\n\r\n" if sys.argv[1] == "raw" else b"")
    server = zmq.Context().socket(zmq.REP)
    if port is None:
        port = server.bind_to_random_port("tcp://127.0.0.1")
    else:
        server.bind("tcp://127.0.0.1:" + port)
    print("port", port, flush=True)
    os.close(1)
    while True:
        message = server.recv()
        if message == b"slow":
            time.sleep(1)
        elif message == b"never":
            time.sleep(60)
        elif message == b"huge":
            message = bytes(2 << 20)
        elif message == b"parts":
            server.send(b"one", zmq.SNDMORE)
        server.send(message)


main()
