"""A WebSocket server that behaves well or badly, as the first message's text asks.

echo          sends every message back
pings         pings ten times a second and closes when no pong comes within a second
traceback     sends a text and closes with 1011
closes        closes at once with a reason
never         never answers
pieces        answers in fragments
huge          answers with 2 MiB
gone          drops the connection without a word
"""
import asyncio
import os
import sys

import websockets


async def handle(socket):
    mode = (await socket.recv()).decode()
    if mode == "traceback":
        await socket.send("Traceback (most recent call last):\n  ValueError: no such key")
        await socket.close(1011, "Internal server error.")
    elif mode == "closes":
        await socket.close(1000, "enough")
    elif mode == "never":
        await asyncio.sleep(60)
    elif mode == "pieces":
        await socket.send([b"one ", b"whole ", b"message"])
    elif mode == "huge":
        await socket.send(bytes(2 << 20))
    elif mode == "gone":
        socket.transport.abort()
    async for message in socket:
        await socket.send(message)


async def main():
    fast = len(sys.argv) > 1 and sys.argv[1] == "pings"
    interval, timeout = (0.1, 1) if fast else (None, None)
    async with websockets.serve(handle, "127.0.0.1", 0, compression=None, max_size=None,
                                ping_interval=interval, ping_timeout=timeout) as server:
        print("port", server.sockets[0].getsockname()[1])
        sys.stdout.flush()
        os.close(1)
        await asyncio.Future()


asyncio.run(main())
