"""An openpi server whose four actions follow from the bytes of the observation and nothing else, so that
a run with it has the same traces however often server and client are killed. It also takes INT-ACT's
messages; then they follow from the model's path too.

openpi_digest_server.py [PORT]    prints "port N" when it listens; 0 or nothing: any free port
"""
import asyncio
import hashlib
import os
import struct
import sys

import msgpack
import websockets


def actions(observation):
    """Moves of at most 8 mm and 0.02 rad, and a gripper that is open or closed."""
    digest = hashlib.shake_256(observation).digest(4 * 7)
    steps = []
    for step in range(4):
        drawn = [byte / 127.5 - 1 for byte in digest[7 * step:7 * step + 7]]
        steps += [0.008 * x for x in drawn[:3]] + [0.02 * x for x in drawn[3:6]]
        steps.append(1.0 if drawn[6] > 0 else -1.0)
    return {b"__ndarray__": True, b"data": struct.pack("<28d", *steps), b"dtype": "<f8",
            b"shape": [4, 7]}


model = None  # of all connections, as INT-ACT's server has it


async def handle(socket):
    global model
    await socket.send(msgpack.packb({}))
    async for message in socket:
        # An array's keys are bytes, which makes all maps' keys of both kinds.
        asked = msgpack.unpackb(message, strict_map_key=False)
        if "new_model_path" in asked:
            model = asked["new_model_path"]
            answer = {"status": "model switched"}
        elif "reset" in asked:
            answer = {"status": "reset"}
        elif model is not None:
            answer = actions(model.encode() + message)
        else:
            answer = {"actions": actions(message)}
        await socket.send(msgpack.packb(answer))


async def main():
    port = int(sys.argv[1]) if len(sys.argv) > 1 else 0
    async with websockets.serve(handle, "127.0.0.1", port, compression=None,
                                max_size=None) as server:
        print("port", server.sockets[0].getsockname()[1])
        sys.stdout.flush()
        os.close(1)
        await asyncio.Future()


asyncio.run(main())
