"""A ZeroMQ REP server that behaves well or badly, as the message's text asks.

echo:...  sends the message back
slow      answers after 1 s
never     never answers
huge      answers with 2 MiB
parts     answers in two parts
With the argument `raw` it is no ZeroMQ server: it sends HTTP to whoever connects; with `silent`
it accepts and says nothing.
"""
import os
import socket
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


def main():
    if len(sys.argv) > 1:
        serve_raw(b"HTTP/1.1 400 Bad Request\r\n\r\n" if sys.argv[1] == "raw" else b"")
    server = zmq.Context().socket(zmq.REP)
    port = server.bind_to_random_port("tcp://127.0.0.1")
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
