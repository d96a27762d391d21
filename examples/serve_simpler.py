#!/usr/bin/env python3
"""Serves a policy of SimplerEnv's manner to vlaprobe, with the standard library and numpy alone.

    python3 examples/serve_simpler.py my_module:policy --port 8000
    vlaprobe run suite/intact.probe --policy "openpi://localhost:8000?profile=simpler_shim" -o runs/mine

`my_module.policy` has reset(task) and step(image, task), which returns (raw_action, action) with
action's world_vector (3, m), rot_axangle (3, rad) and gripper (1, +1 open). Or it is a function that
makes such an object: then every connection has its own, and `--jobs` may be more than 1; one object
serves one connection after the other. A step that takes eef_pos gets the end effector's too, a function
that takes path the address's: `ws://localhost:8000/PATH?profile=simpler_shim` can name a checkpoint.

A policy that keeps nothing between steps may have step_batch(images, tasks), which returns a list of
what step returns: `--jobs 8 --policy "openpi://...?profile=simpler_shim&connection=kept&batch=8"`
then asks for all worlds that wait in one message. It may take eef_pos, too, a list of them.

For a chunk of n actions world_vector and rot_axangle have n rows, and gripper n numbers; the profile, or
the address, says `chunk.length=n`.
"""
import argparse
import base64
import contextlib
import hashlib
import importlib
import inspect
import socketserver
import struct
import sys
import threading
import traceback

import numpy

NUMBERS = dict(zip(range(0xca, 0xd4), ">f >d >B >H >I >Q >b >h >i >q".split()))
SIZES = dict(zip((0xc4, 0xc5, 0xc6, 0xd9, 0xda, 0xdb, 0xdc, 0xdd, 0xde, 0xdf),
                 ">B >H >I >B >H >I >H >I >H >I".split()))


def unpack(data, at=0):
    """One MessagePack value from `data` at `at`, and where it ends. Arrays have keys of bytes."""
    tag, at = data[at], at + 1
    if tag < 0x80 or tag >= 0xe0:
        return (tag if tag < 0x80 else tag - 256), at
    if 0xc0 <= tag <= 0xc3:
        return {0xc2: False, 0xc3: True}.get(tag), at
    if tag in NUMBERS:
        return struct.unpack_from(NUMBERS[tag], data, at)[0], at + struct.calcsize(NUMBERS[tag])
    size = tag & (0x1f if tag >= 0xa0 else 0x0f)
    if tag in SIZES:
        size, at = struct.unpack_from(SIZES[tag], data, at)[0], at + struct.calcsize(SIZES[tag])
    if 0xc4 <= tag <= 0xc6:
        return bytes(data[at:at + size]), at + size
    if 0xd9 <= tag <= 0xdb or 0xa0 <= tag < 0xc0:
        return str(data[at:at + size], "utf-8"), at + size
    is_list, values = 0x90 <= tag < 0xa0 or 0xdc <= tag <= 0xdd, []
    for _ in range(size if is_list else 2 * size):
        value, at = unpack(data, at)
        values.append(value)
    table = values if is_list else dict(zip(values[::2], values[1::2]))
    if b"__ndarray__" in table:
        table = numpy.frombuffer(table[b"data"], table[b"dtype"]).reshape(table[b"shape"])
    return table, at


def pack_actions(actions):
    """{"actions": float64 [n, 7]} as openpi's server writes it; n is at most 1000."""
    data = numpy.ascontiguousarray(actions, "<f8").tobytes()
    return (b"\x81\xa7actions\x84\xc4\x0b__ndarray__\xc3\xc4\x04data\xc5" +
            struct.pack(">H", len(data)) + data + b"\xc4\x05dtype\xa3<f8\xc4\x05shape\x92\xcd" +
            struct.pack(">H", len(actions)) + b"\x07")


def pack_step(answer):
    action = answer[1]
    parts = ((action["world_vector"], 3), (action["rot_axangle"], 3), (action["gripper"], 1))
    return pack_actions(numpy.concatenate([numpy.reshape(part, (-1, n)) for part, n in parts], 1))


def takes(function, name):
    return name in inspect.signature(function).parameters


class Connection(socketserver.StreamRequestHandler):
    """One WebSocket: the upgrade, then messages until it is closed."""

    def handle(self):
        request, fields = self.rfile.readline(8192), {}
        while (line := self.rfile.readline(8192).strip()) and len(fields) < 100:
            name, _, value = line.partition(b":")
            fields[name.strip().lower()] = value.strip()
        if b"sec-websocket-key" not in fields:
            known = request.startswith(b"GET /healthz")
            return self.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Length: 3\r\n\r\nOK\n" if known else
                                    b"HTTP/1.1 426 Upgrade Required\r\nContent-Length: 0\r\n\r\n")
        key = fields[b"sec-websocket-key"] + b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
        self.wfile.write(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                         b"Connection: Upgrade\r\nSec-WebSocket-Accept: " +
                         base64.b64encode(hashlib.sha1(key).digest()) + b"\r\n\r\n")
        self.send(2, b"\x80")  # no metadata
        self.task = None
        path = request.split(b" ")[1].partition(b"?")[0].decode().strip("/")
        with self.server.policy(path) as policy:
            while (message := self.receive()) is not None:
                try:
                    self.send(2, self.answer(policy, unpack(message)[0]))
                except Exception:  # as openpi's: the traceback as a text, then goodbye
                    traceback.print_exc()
                    self.send(1, traceback.format_exc().encode())
                    return self.send(8, struct.pack(">H", 1011) + b"Internal server error.")

    def answer(self, policy, request):
        if "batch" in request:
            items = request["batch"]
            poses = ({"eef_pos": [item["observation/state"] for item in items]}
                     if takes(policy.step_batch, "eef_pos") else {})
            answers = policy.step_batch([item["observation/image"] for item in items],
                                        [item["prompt"] for item in items], **poses)
            return (b"\x81\xa5batch\xdc" + struct.pack(">H", len(answers)) +
                    b"".join(pack_step(answer) for answer in answers))
        image, task = request["observation/image"], request["prompt"]
        if task != self.task:  # the first of this connection, or another task on it
            policy.reset(task)
            self.task = task
        pose = {"eef_pos": request["observation/state"]} if takes(policy.step, "eef_pos") else {}
        return pack_step(policy.step(image, task, **pose))

    def receive(self):
        """The next whole message, or None at the end."""
        message = b""
        while len(head := self.rfile.read(2)) == 2 and head[0] & 15 != 8:
            size = head[1] & 127
            if size > 125:
                size = int.from_bytes(self.rfile.read(2 if size == 126 else 8), "big")
            if len(message) + size > 64 << 20:
                break
            mask, data = (numpy.frombuffer(self.rfile.read(n), "u1") for n in (4, size))
            data = (data ^ numpy.tile(mask, size // 4 + 1)[:size]).tobytes()
            if head[0] & 15 == 9:
                self.send(10, data)
            elif head[0] & 15 < 3:
                message += data
                if head[0] & 128:
                    return message

    def send(self, kind, data):
        size = len(data)
        self.wfile.write((struct.pack(">BB", 128 | kind, size) if size < 126 else
                          struct.pack(">BBH", 128 | kind, 126, size) if size < 65536 else
                          struct.pack(">BBQ", 128 | kind, 127, size)) + data)


def serve(policy, port, host="127.0.0.1"):
    lock = threading.Lock()
    @contextlib.contextmanager
    def chosen(path):
        made = callable(policy)
        with contextlib.nullcontext() if made else lock:
            if not made:
                yield policy
            else:
                yield policy(path=path) if takes(policy, "path") else policy()

    socketserver.ThreadingTCPServer.allow_reuse_address = True
    with socketserver.ThreadingTCPServer((host, port), Connection) as server:
        server.policy, server.daemon_threads = chosen, True
        print("port", server.server_address[1], flush=True)
        server.serve_forever()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="serve a SimplerEnv policy to vlaprobe")
    parser.add_argument("policy", help="MODULE:NAME, an object or a function that makes one")
    parser.add_argument("--port", type=int, default=8000)
    parser.add_argument("--host", default="127.0.0.1", help="0.0.0.0 lets other machines in")
    args = parser.parse_args()
    sys.path.insert(0, ".")
    module, _, name = args.policy.partition(":")
    serve(getattr(importlib.import_module(module), name), args.port, args.host)
