"""A policy server that misbehaves in one way at a time, for every protocol.

fault_server.py openpi|intact|vlaeval|gr00t|openvla|roboarena|starvla [connect=FAULT] [port=N]

It answers well until a prompt reads "fault:NAME": then that answer fails as named in AT_ANSWER. With
`connect` every connection fails as named in AT_CONNECTION. Frames are made by hand, because real
libraries would not send these.
"""
import asyncio
import base64
import hashlib
import json
import os
import random
import re
import struct
import sys
import time

import msgpack

protocol = sys.argv[1]
options = dict(word.split("=", 1) for word in sys.argv[2:])
GOOD = [0.0, 0, 0, 0, 0, 0, 1]
TRACEBACK = 'Traceback (most recent call last):\n  File "policy.py", line 3, in infer\nKeyError: \'x\''
GARBAGE = random.Random(1).randbytes(200)


# ---- framing ------------------------------------------------------------------------------------

class WebSocket:
    """RFC 6455 with unfragmented messages."""

    def __init__(self, reader, writer):
        self.reader, self.writer = reader, writer

    async def accept(self):
        head = (await self.reader.readuntil(b"\r\n\r\n")).decode()
        key = re.search(r"Sec-WebSocket-Key: (\S+)", head, re.I).group(1)
        guid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
        accept = base64.b64encode(hashlib.sha1((key + guid).encode()).digest())
        self.writer.write(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                          b"Connection: Upgrade\r\nSec-WebSocket-Accept: " + accept + b"\r\n\r\n")

    async def read(self):
        while True:
            first, second = await self.reader.readexactly(2)
            size = second & 127
            if size == 126:
                size, = struct.unpack(">H", await self.reader.readexactly(2))
            elif size == 127:
                size, = struct.unpack(">Q", await self.reader.readexactly(8))
            mask = await self.reader.readexactly(4)
            data = await self.reader.readexactly(size)
            if first & 15 == 8:
                raise EOFError
            if first & 15 in (1, 2):
                return unmasked(data, mask)

    def frame(self, data, claim=None, opcode=2):
        size = len(data) if claim is None else claim
        if size < 126:
            head = bytes([size])
        else:
            head = b"\x7e" + struct.pack(">H", size) if size < 65536 else b"\x7f" + struct.pack(
                ">Q", size)
        return bytes([0x80 | opcode]) + head + data

    def goodbye(self):
        return self.frame(struct.pack(">H", 1011) + b"out of memory", opcode=8)


def unmasked(data, mask):
    whole = int.from_bytes(data, "big")
    repeated = int.from_bytes((mask * (len(data) // 4 + 1))[:len(data)], "big")
    return (whole ^ repeated).to_bytes(len(data), "big")


class Zmtp:
    """ZMTP 3.0, mechanism NULL, a REP socket."""

    def __init__(self, reader, writer):
        self.reader, self.writer = reader, writer

    async def accept(self):
        self.writer.write(b"\xff" + bytes(8) + b"\x7f\x03\x00NULL" + bytes(48))
        await self.reader.readexactly(64)
        body = b"\x05READY\x0bSocket-Type" + struct.pack(">I", 3) + b"REP" + \
            b"\x08Identity" + struct.pack(">I", 0)
        self.writer.write(bytes([4, len(body)]) + body)
        await self.part()

    async def part(self):
        flags, = await self.reader.readexactly(1)
        if flags & 2:
            size, = struct.unpack(">Q", await self.reader.readexactly(8))
        else:
            size, = await self.reader.readexactly(1)
        return flags, await self.reader.readexactly(size)

    async def read(self):
        while True:
            flags, data = await self.part()
            if not flags & 5:  # neither more to come nor a command
                return data

    def frame(self, data, claim=None):
        size = len(data) if claim is None else claim
        return b"\x01\x00\x02" + struct.pack(">Q", size) + data

    def goodbye(self):
        return b""


class Http:
    def __init__(self, reader, writer):
        self.reader, self.writer = reader, writer

    async def accept(self):
        pass

    async def read(self):
        head = (await self.reader.readuntil(b"\r\n\r\n")).decode()
        size = re.search(r"Content-Length: (\d+)", head, re.I)
        return await self.reader.readexactly(int(size.group(1))) if size else b"GET"

    def frame(self, data, claim=None, status="200 OK"):
        size = len(data) if claim is None else claim
        return f"HTTP/1.1 {status}\r\nContent-Length: {size}\r\n\r\n".encode() + data

    def goodbye(self):
        return b""


FRAMING = {"gr00t": Zmtp, "openvla": Http}.get(protocol, WebSocket)

# What is said of the server before anything is asked.
METADATA = {
    "openpi": {}, "intact": {}, "starvla": {"env": "starvla_policy_server"},
    "roboarena": {"image_resolution": None, "needs_wrist_camera": False, "n_external_cameras": 1,
                  "needs_stereo_camera": False, "needs_session_id": True,
                  "action_space": "cartesian_velocity"}}


# ---- messages -----------------------------------------------------------------------------------

def array(numbers):
    """Of float64, as each protocol writes it."""
    data = struct.pack(f"<{len(numbers)}d", *numbers)
    if protocol == "openvla":
        return {"__numpy__": base64.b64encode(data).decode(), "dtype": "<f8",
                "shape": [len(numbers)]}
    names = ["__ndarray__", "data", "dtype", "shape"]
    if protocol != "vlaeval":
        names = [name.encode() for name in names]
    return dict(zip(names, [True, data, "<f8", [len(numbers)]]))


def envelope(kind, payload, seq):
    return {"type": kind, "payload": payload, "seq": seq, "timestamp": time.time()}


def action_message(numbers, seq):
    if protocol == "openvla":
        return json.dumps(array(numbers)).encode()
    if protocol in ("openpi", "roboarena"):
        return msgpack.packb({"actions": array(numbers)})
    if protocol == "starvla":
        return msgpack.packb({"status": "ok", "ok": True, "type": "inference_result",
                              "request_id": str(seq), "data": {"actions": array(numbers)}})
    if protocol == "intact":
        return msgpack.packb(array(numbers))
    if protocol == "vlaeval":
        return msgpack.packb(envelope("action", {"actions": array(numbers)}, seq))
    names = ["x", "y", "z", "roll", "pitch", "yaw", "gripper"]
    return msgpack.packb([{"action." + n: [[v]] for n, v in zip(names, numbers)}, {}])


def other_message(seq):
    """Well formed, and nothing that was asked for."""
    if protocol == "openvla":
        return json.dumps({"detail": "not an action"}).encode()
    if protocol == "vlaeval":
        return msgpack.packb(envelope("action", {"values": 1}, seq))
    return msgpack.packb({"values": 1})


def failure_frame(wire, seq):
    """How each protocol's own servers report an exception."""
    if protocol == "openvla":
        return wire.frame(TRACEBACK.encode(), status="500 Internal Server Error")
    if protocol == "vlaeval":
        error = {"error": "observation_failed: KeyError: 'x'"}
        return wire.frame(msgpack.packb(envelope("error", error, seq)))
    if protocol == "gr00t":
        return wire.frame(msgpack.packb({"error": TRACEBACK}))
    if protocol == "starvla":
        return wire.frame(msgpack.packb({"status": "error", "ok": False,
                                         "error": {"message": TRACEBACK}}))
    return wire.frame(TRACEBACK.encode(), opcode=1)


def side_answer(request):
    """To what is no observation; nothing for an observation, None where no answer is due."""
    if protocol == "openvla":
        return b'{"detail": "Not Found"}' if request == b"GET" else b""
    message = msgpack.unpackb(request, strict_map_key=False)
    if protocol == "vlaeval":
        kind = message["type"]
        if kind == "hello":
            return msgpack.packb(envelope("hello", {"protocol_version": 1}, message["seq"]))
        return b"" if kind == "observation" else None
    if protocol == "intact":
        if "new_model_path" in message:
            return msgpack.packb({"status": "model switched"})
        return msgpack.packb({"status": "reset"}) if "reset" in message else b""
    if protocol == "roboarena":
        return b"reset successful" if message["endpoint"] == "reset" else b""
    if protocol == "gr00t":
        return b"" if message["endpoint"] == "get_action" else msgpack.packb({"status": "ok"})
    return b""


# ---- faults -------------------------------------------------------------------------------------

async def never(wire, seq):
    await asyncio.sleep(60)


async def slow(wire, seq):
    await asyncio.sleep(0.15)
    wire.writer.write(wire.frame(action_message(GOOD, seq)))


async def gone(wire, seq):
    wire.writer.transport.abort()


async def closes(wire, seq):
    wire.writer.write(wire.goodbye())
    await wire.writer.drain()
    wire.writer.close()


async def half(wire, seq):
    message = wire.frame(action_message(GOOD, seq))
    wire.writer.write(message[:len(message) - 20])
    await wire.writer.drain()
    wire.writer.close()


async def trickle(wire, seq):
    for byte in wire.frame(action_message(GOOD, seq)):
        wire.writer.write(bytes([byte]))
        await wire.writer.drain()
        await asyncio.sleep(0.05)


async def flood(wire, seq):
    for _ in range(200):
        wire.writer.write(wire.frame(other_message(seq + 100)))
    await wire.writer.drain()
    await asyncio.sleep(60)


def sends(make):
    async def send(wire, seq):
        wire.writer.write(make(wire, seq))
    return send


def numbers(values):
    return sends(lambda wire, seq: wire.frame(action_message(values, seq)))


AT_ANSWER = {
    "never": never, "slow": slow, "gone": gone, "closes": closes, "half": half,
    "trickle": trickle, "flood": flood,
    "traceback": sends(failure_frame),
    "shape": numbers([0.0] * 6) if protocol != "gr00t" else
             sends(lambda wire, seq: wire.frame(msgpack.packb([{"action.x": [0.0]}, {}]))),
    "nan": numbers([0.0, float("nan"), 0, 0, 0, 0, 1]),
    "far": numbers([1000.0, 0, 0, 0, 0, 0, 1]),
    "other": sends(lambda wire, seq: wire.frame(other_message(seq))),
    "huge": sends(lambda wire, seq: wire.frame(bytes(2 << 20))),
    "claims": sends(lambda wire, seq: wire.frame(b"", claim=1 << 40)),
    "garbage": sends(lambda wire, seq: wire.frame(GARBAGE)),
    "raw": sends(lambda wire, seq: GARBAGE),
    "empty": sends(lambda wire, seq: wire.frame(b"")),
}


async def silent(wire):
    await asyncio.sleep(60)


async def hangs_up(wire):
    wire.writer.close()


async def babbles(wire):
    wire.writer.write(GARBAGE)
    await wire.writer.drain()
    wire.writer.close()


async def unavailable(wire):
    wire.writer.write(b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 7\r\n\r\nloading")
    await wire.writer.drain()
    wire.writer.close()


async def speechless(wire):
    """The framing is right, and then there is no first message."""
    await wire.accept()
    await asyncio.sleep(60)


async def complains(wire):
    await wire.accept()
    if protocol in ("vlaeval", "gr00t", "openvla"):
        await wire.read()
    wire.writer.write(failure_frame(wire, 1))
    await wire.writer.drain()
    await asyncio.sleep(60)


AT_CONNECTION = {"silent": silent, "hangs_up": hangs_up, "babbles": babbles,
                 "unavailable": unavailable, "speechless": speechless, "complains": complains}


async def serve(wire):
    if "connect" in options:
        return await AT_CONNECTION[options["connect"]](wire)
    await wire.accept()
    if protocol in METADATA:
        wire.writer.write(wire.frame(msgpack.packb(METADATA[protocol])))
    seq = 0
    while True:
        request = await wire.read()
        side = side_answer(request)
        if protocol == "vlaeval":
            seq = msgpack.unpackb(request, strict_map_key=False)["seq"]
        if protocol == "starvla":
            seq = int(msgpack.unpackb(request, strict_map_key=False)["request_id"])
        if side is None:
            continue
        fault = re.search(rb"fault:(\w+)", request)
        if side:
            is_text = {"opcode": 1} if protocol == "roboarena" else {}
            wire.writer.write(wire.frame(side, **is_text))
        elif fault:
            await AT_ANSWER[fault.group(1).decode()](wire, seq)
        else:
            wire.writer.write(wire.frame(action_message(GOOD, seq)))
        await wire.writer.drain()
        if protocol == "openvla":
            return wire.writer.close()


async def handle(reader, writer):
    try:
        await serve(FRAMING(reader, writer))
    except (EOFError, ConnectionError, asyncio.IncompleteReadError):
        writer.close()


async def main():
    server = await asyncio.start_server(handle, "127.0.0.1", int(options.get("port", 0)),
                                        limit=1 << 24)
    print("port", server.sockets[0].getsockname()[1], flush=True)
    os.close(1)
    await server.serve_forever()


asyncio.run(main())
