"""A server that speaks vla-eval's protocol 1 as its serve.py does, and is as strict.

vlaeval_server.py [actions=FILE] [bridge=1] [params=JSON] [spec=JSON] [pose=JSON] [version=N]
                  [record=FILE] [gathers=MOST]

Answers the actions of recorded_actions, or one whose first number is the step / 1000; with `bridge`
the gripper as 0 to 1. `params` and `spec` are the observation_params and
the action_spec of its hello, and `pose` is what it answers always. `record` gets a JSON line
for every message: its type, its keys and what was in an observation. With `gathers` GET /config
says and changes how batches are gathered, up to MOST, as serve.py's does.
"""
import asyncio
import http
import json
import os
import sys
import time
import urllib.parse

import msgpack
import numpy
import websockets

import recorded_actions

options = dict(word.split("=", 1) for word in sys.argv[1:])
episodes = recorded_actions.load(options["actions"]) if "actions" in options else None


def encode(obj):
    if isinstance(obj, numpy.ndarray):
        return {"__ndarray__": True, "data": obj.tobytes(), "dtype": obj.dtype.str,
                "shape": list(obj.shape)}
    raise TypeError(type(obj))


def decode(obj):
    if "__image__" in obj:
        assert obj["format"] in ("png", "jpeg") and len(obj["shape"]) == 3
        begin = {"png": b"\x89PNG", "jpeg": b"\xff\xd8\xff"}[obj["format"]]
        assert obj["data"].startswith(begin)
        return numpy.zeros(obj["shape"], numpy.uint8)
    if "__ndarray__" in obj:
        assert numpy.dtype(obj["dtype"]).kind in "biuf"
        return numpy.frombuffer(obj["data"], obj["dtype"]).reshape(obj["shape"])
    return obj


def pack(kind, payload, seq):
    return msgpack.packb({"type": kind, "payload": payload, "seq": seq, "timestamp": time.time()},
                         default=encode, use_bin_type=True)


def unpack(data):
    message = msgpack.unpackb(data, object_hook=decode, raw=False)
    for field in ("type", "payload", "seq", "timestamp"):
        if field not in message:
            raise ValueError("Message missing required fields: " + field)
    return message


def note(message):
    if "record" not in options:
        return
    payload = message["payload"]
    line = {"type": message["type"], "keys": sorted(payload)}
    if message["type"] == "observation":
        line["images"] = {k: list(v.shape) for k, v in payload["images"].items()}
        line["state"] = payload["states"].tolist() if "states" in payload else None
    elif message["type"] != "hello":
        line["payload"] = payload
    with open(options["record"], "a") as file:
        file.write(json.dumps(line) + "\n")


class Policy:
    def start(self, config):
        assert isinstance(config["task"]["name"], str)
        self.step = 0
        self.recorded = recorded_actions.RecordedPolicy(episodes) if episodes else None

    def predict(self, obs):
        image = obs["images"]["primary"]
        assert image.dtype == numpy.uint8 and image.shape[2] == 3, image.shape
        assert isinstance(obs["task_description"], str) and isinstance(obs["task_name"], str)
        action = self.recorded.answer(image, 1)[0] if self.recorded else numpy.zeros(7)
        if not self.recorded:
            action[0], action[6] = self.step / 1000, 1
        if "bridge" in options:
            action = action.copy()
            action[6] = (action[6] + 1) / 2
        if "pose" in options:
            action = numpy.array(json.loads(options["pose"]))
        self.step += 1
        return {"actions": action}


async def handle(socket):
    policy = Policy()
    async for data in socket:
        message = unpack(data)
        note(message)
        kind, payload, seq = message["type"], message["payload"], message["seq"]
        if kind == "hello":
            reply = {"harness_version": "0.2.0", "protocol_version": int(options.get("version", 1)),
                     "model_server": "Recorded", "capabilities": {}}
            if "params" in options:
                reply["observation_params"] = json.loads(options["params"])
            if "spec" in options:
                reply["action_spec"] = json.loads(options["spec"])
            await socket.send(pack("hello", reply, seq))
        elif kind == "episode_start":
            try:
                policy.start(payload)
            except Exception as error:
                await socket.send(pack("error", {"error": f"episode_start_failed: {error!r}"}, seq))
        elif kind == "observation":
            try:
                await socket.send(pack("action", policy.predict(payload), seq))
            except Exception as error:
                await socket.send(pack("error", {"error": f"observation_failed: {error!r}"}, seq))
        elif kind == "episode_end":
            assert isinstance(payload["metrics"]["success"], bool), payload
        else:
            raise ValueError("Unknown message type: " + kind)


config = {"max_batch_size": 1, "max_wait_time": 0.01}


async def page(path, headers):
    url = urllib.parse.urlparse(path)
    if url.path != "/config" or "gathers" not in options:
        return None
    applied = {key: type(config[key])(values[-1])
               for key, values in urllib.parse.parse_qs(url.query).items() if key in config}
    applied["max_batch_size"] = min(applied["max_batch_size"], int(options["gathers"]))
    config.update(applied)
    note({"type": "config", "payload": dict(config)})
    return http.HTTPStatus.OK, [], json.dumps({"applied": applied, "config": config}).encode()


async def main():
    async with websockets.serve(handle, "127.0.0.1", 0, compression=None, max_size=None,
                                ping_interval=None, process_request=page) as server:
        print("port", server.sockets[0].getsockname()[1], flush=True)
        os.close(1)
        await asyncio.Future()


asyncio.run(main())
