"""A server that speaks openpi's protocol or one of its dialects as their own servers do, and is as
strict as they are.

openpi_server.py openpi|droid|libero|intact|roboarena [chunk=N] [record=FILE] [actions=FILE] [seen=HABIT]
                 [key=KEY] [lacks=MODEL] [port=N] [meta=JSON] [warm=N] [lag=N]

Answers chunks of N actions whose first number is the count of actions answered so far / 1000, or
those of recorded_actions, or with `seen` small ones that depend on what was asked alone, where HABIT
is `fine` or what is to be wrong: unit, inverted, euler, vector, normalised, noise, deaf,
blind, numb (to the state), nan, six, poses, joints (of the state), or keeps: the instruction of the first question since the last reset, of whichever
connection, as INT-ACT's wrapper of Octo does. `record` gets every message that comes, a line of hexadecimal digits each. The
first `warm` questions fail. From the question `lag` of the first connection with so
many on, whose answer comes twice, each is answered with that of the one before, and its own comes
with the next question, or 10 ms later. With
`key` a client without this Api-Key is refused; INT-ACT's server, which has one model for all its
connections, fails to load the model `lacks` and then can load no other.
"""
import asyncio
import functools
import hashlib
import http
import json
import os
import sys
import traceback

import msgpack
import numpy
import websockets

import recorded_actions


def pack_array(obj):
    """openpi_client.msgpack_numpy: keys are bytes."""
    if isinstance(obj, numpy.ndarray):
        return {b"__ndarray__": True, b"data": obj.tobytes(), b"dtype": obj.dtype.str,
                b"shape": obj.shape}
    if isinstance(obj, numpy.generic):
        return {b"__npgeneric__": True, b"data": obj.item(), b"dtype": obj.dtype.str}
    return obj


def unpack_array(obj):
    if b"__ndarray__" in obj:
        return numpy.ndarray(buffer=obj[b"data"], dtype=numpy.dtype(obj[b"dtype"]),
                             shape=obj[b"shape"])
    if b"__npgeneric__" in obj:
        return numpy.dtype(obj[b"dtype"]).type(obj[b"data"])
    return obj


pack = functools.partial(msgpack.packb, default=pack_array)
unpack = functools.partial(msgpack.unpackb, object_hook=unpack_array)

dialect = sys.argv[1]
options = dict(word.split("=", 1) for word in sys.argv[2:])
chunk = int(options.get("chunk", 1))
episodes = recorded_actions.load(options["actions"]) if "actions" in options else None
BROKEN = object()
METADATA = {
    "openpi": {},
    "droid": {},
    "libero": {},
    "intact": {},
    "roboarena": {"image_resolution": [224, 224], "needs_wrist_camera": False,
                  "n_external_cameras": 1, "needs_stereo_camera": False, "needs_session_id": True,
                  "action_space": "cartesian_velocity"},
}
METADATA[dialect] = json.loads(options["meta"]) if "meta" in options else METADATA[dialect]


def seen_actions(image, prompt, state, habit):
    seen = (b"" if habit == "blind" else image.tobytes()) + (b"" if habit == "deaf" else
                                                             prompt.encode())
    if habit != "numb":
        seen += state.tobytes()
    seed = None if habit == "noise" else int.from_bytes(hashlib.sha256(seen).digest()[:4], "big")
    draws = numpy.random.default_rng(seed)
    if dialect == "droid":  # velocities of seven joints, and the gripper open
        actions = draws.uniform(-0.1, 0.1, (chunk, 8))
        actions[:, 7] = 0
        return actions
    actions = draws.uniform(-0.02, 0.02, (chunk, 7))
    actions[:, 6] = 1
    if habit == "unit":
        actions[:, 6] = draws.uniform(0.6, 1, chunk)
    elif habit == "inverted":
        actions[:, 6] = -1
    elif habit == "euler":
        actions[:, 3:6] = [2.5, 0.1, 2.5] + draws.uniform(0, 0.1, (chunk, 3))
    elif habit == "vector":
        actions[:, 3:6] = [0.1, 2.5, 0.1] + draws.uniform(0, 0.1, (chunk, 3))
    elif habit == "normalised":
        actions[:, :6] = draws.uniform(-1, 1, (chunk, 6))
    elif habit == "poses":
        actions[:, :3] += state[:3]
    elif habit == "joints":
        actions[:, :6] += state[:6]
    elif habit == "nan":
        actions[:, 2] = numpy.nan
    return actions[:, :6] if habit == "six" else actions


warming = int(options.get("warm", 0))
kept = None  # instruction, of all connections
loaded = None  # model, of all connections


class Policy:
    def __init__(self):
        self.recorded = recorded_actions.RecordedPolicy(episodes) if episodes else None
        self.count = 0

    def infer(self, image, prompt="", state=numpy.zeros(8)):
        global kept, warming
        if warming > 0:
            warming -= 1
            raise RuntimeError("warming up")
        assert image.dtype == numpy.uint8 and image.ndim >= 3 and image.shape[-1] == 3, image.shape
        if self.recorded:
            return self.recorded.answer(image, chunk)
        if "seen" in options:
            if options["seen"] == "keeps":
                kept = prompt if kept is None else kept
                prompt = kept
            return seen_actions(image, prompt, state, options["seen"])
        actions = numpy.zeros((chunk, 7))
        actions[:, 0] = (self.count + numpy.arange(chunk)) / 1000
        actions[:, 6] = 1
        self.count += chunk
        return actions

    def reset(self):
        global kept
        kept = None
        self.count = 0
        if self.recorded:
            self.recorded.reset()


def answer_openpi(policy, request):
    assert set(request) == {"observation/image", "observation/state", "prompt"}, set(request)
    assert isinstance(request["prompt"], str)
    assert request["observation/state"].shape == (8,)
    return pack({"actions": policy.infer(request["observation/image"], request["prompt"],
                                         request["observation/state"]),
                 "server_timing": {"infer_ms": 1.5}})


def answer_droid(policy, request):
    """As openpi's DroidInputs reads it."""
    image, wrist = (request["observation/" + name] for name in ("exterior_image_1_left",
                                                                "wrist_image_left"))
    assert image.shape == wrist.shape == (224, 224, 3)
    joints, gripper = request["observation/joint_position"], request["observation/gripper_position"]
    assert joints.shape == (7,) and gripper.shape == (1,), (joints.shape, gripper.shape)
    return pack({"actions": policy.infer(image, request["prompt"],
                                         numpy.concatenate([joints, gripper]))})


def answer_libero(policy, request):
    """As openpi's LiberoInputs reads it."""
    images = [request["observation/" + name] for name in ("image", "wrist_image")]
    assert all(image.shape == (224, 224, 3) for image in images)
    assert request["observation/state"].shape == (8,)
    return pack({"actions": policy.infer(numpy.stack(images), request["prompt"],
                                         request["observation/state"])})


def answer_intact(policy, request):
    global loaded
    if "new_model_path" in request:
        if loaded is BROKEN:
            raise AttributeError("'OctoPolicyWrapper' object has no attribute 'model'")
        if request["new_model_path"] == options.get("lacks"):
            loaded = BROKEN
            raise FileNotFoundError(request["new_model_path"])
        loaded = request["new_model_path"]
        return pack({"status": "model switched"})
    if loaded is None and "reset" in request:
        raise ValueError("Model is not initialized. Please initialize model first.")
    if loaded is None:
        raise AttributeError("'NoneType' object has no attribute 'preprocess'")
    if "reset" in request:
        policy.reset()
        return pack({"status": "reset"})
    assert request["observation.state"]["agent"]["eef_pos"].shape == (8,)
    assert isinstance(request["task"], str)
    actions = policy.infer(request["observation.images.top"], request["task"],
                           request["observation.state"]["agent"]["eef_pos"])
    return pack(actions if chunk > 1 else [actions[0]])


def answer_roboarena(policy, request):
    endpoint = request.pop("endpoint")
    if endpoint == "reset":
        assert set(request) == {"session_id"}, set(request)
        policy.reset()
        return "reset successful"
    assert set(request) == {"observation/exterior_image_1_left", "observation/joint_position",
                            "observation/cartesian_position", "observation/gripper_position",
                            "session_id", "prompt"}, set(request)
    assert request["observation/exterior_image_1_left"].shape == (224, 224, 3)
    assert request["observation/joint_position"].shape == (7,)
    assert request["observation/cartesian_position"].dtype == numpy.float64
    state = "joint" if options.get("seen") == "joints" else "cartesian"
    actions = policy.infer(request["observation/exterior_image_1_left"], request["prompt"],
                           request["observation/" + state + "_position"])
    return pack({"actions": actions})


ANSWER = {"openpi": answer_openpi, "droid": answer_droid, "libero": answer_libero,
          "intact": answer_intact, "roboarena": answer_roboarena}


class Late:
    """A connection's answers, once out of step with their questions: only one connection's are."""

    has_been = False

    def __init__(self, socket):
        self.socket, self.asked, self.held, self.timer = socket, 0, None, None

    async def send(self, answer, is_question):
        self.asked += is_question
        if is_question and self.asked == int(options.get("lag", 0)) and not Late.has_been:
            Late.has_been = True
            await self.socket.send(answer)
            self.hold(answer)
        elif self.held is None:
            await self.socket.send(answer)
        elif is_question:
            held = self.held
            self.hold(answer)
            await self.socket.send(held)
        else:
            await self.flush()
            await self.socket.send(answer)

    def hold(self, answer):
        if self.timer is not None:
            self.timer.cancel()
        self.held = answer
        self.timer = asyncio.ensure_future(self.flush_later())

    async def flush_later(self):
        await asyncio.sleep(0.01)
        await self.flush()

    async def flush(self):
        held, self.held = self.held, None
        if held is not None:
            await self.socket.send(held)


async def handle(socket):
    policy = Policy()
    late = Late(socket)
    await socket.send(pack(METADATA[dialect]))
    async for message in socket:
        if "record" in options:
            with open(options["record"], "a") as file:
                file.write(message.hex() + "\n")
        try:
            request = unpack(message)
            if dialect == "openpi" and policy.recorded:
                # There is no reset in openpi: a picture that begins an episode does.
                policy.recorded.begin_if_first(request["observation/image"])
            is_question = "reset" not in request and "new_model_path" not in request
            is_question = is_question and request.get("endpoint") != "reset"
            await late.send(ANSWER[dialect](policy, request), is_question)
        except Exception:
            await socket.send(traceback.format_exc())
            await socket.close(1011, "Internal server error. Traceback included in previous frame.")
            return


async def check(path, headers):
    if path == "/healthz":
        return http.HTTPStatus.OK, [], b"OK\n"
    if "key" in options and headers.get("Authorization") != "Api-Key " + options["key"]:
        return http.HTTPStatus.UNAUTHORIZED, [], b"no key\n"
    return None


async def main():
    async with websockets.serve(handle, "127.0.0.1", int(options.get("port", 0)), compression=None, max_size=None,
                                process_request=check) as server:
        print("port", server.sockets[0].getsockname()[1])
        sys.stdout.flush()
        os.close(1)
        await asyncio.Future()


asyncio.run(main())
