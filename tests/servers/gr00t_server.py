"""A server that speaks GR00T's protocol as its server_client.py (n1.6) or service.py (n1.5) does.

gr00t_server.py n1.6|n1.6_nested|n1.5 [actions=FILE] [bridge=1] [chunk=N] [token=TOKEN] [record=FILE]

Answers chunks of N actions, those of recorded_actions or ones whose x is the count of actions so
far / 1000; with `bridge` in BridgeData's convention. `record` gets every request in hexadecimal
digits, a line each.
"""
import io
import os
import sys

import msgpack
import numpy
import zmq

import conventions
import recorded_actions

form = sys.argv[1]
options = dict(word.split("=", 1) for word in sys.argv[2:])
chunk = int(options.get("chunk", 1))
episodes = recorded_actions.load(options["actions"]) if "actions" in options else None
recorded = recorded_actions.RecordedPolicy(episodes) if episodes else None
count = 0
NAMES = ["x", "y", "z", "roll", "pitch", "yaw", "gripper"]
STATE = ["x", "y", "z", "roll", "pitch", "yaw", "pad", "gripper"]
TEXT = "annotation.human.action.task_description"


def encode(obj):
    if isinstance(obj, numpy.ndarray):
        file = io.BytesIO()
        numpy.save(file, obj, allow_pickle=False)
        return {"__ndarray_class__": True, "as_npy": file.getvalue()}
    return obj


def decode(obj):
    if "__ndarray_class__" in obj:
        return numpy.load(io.BytesIO(obj["as_npy"]), allow_pickle=False)
    return obj


def parts_of(observation):
    """Picture, numbers of the state and instruction, or an assertion."""
    if form == "n1.6_nested":
        video, state = observation["video"]["image_0"], observation["state"]
        (text,), = observation["language"][TEXT]
        numbers = [state[name] for name in STATE]
    else:
        video = observation["video.image_0"]
        numbers = [observation["state." + name] for name in STATE]
        text, = observation[TEXT]
    lead = 1 if form == "n1.5" else 2
    assert video.ndim == lead + 3 and video.dtype == numpy.uint8, video.shape
    for number in numbers:
        assert number.shape == (1,) * (lead + 1) and number.dtype == numpy.float32, number.shape
    assert isinstance(text, str)
    return video.reshape(video.shape[-3:]), text


def get_action(observation):
    global count
    image, _ = parts_of(observation)
    if recorded:
        recorded.begin_if_first(image)
        actions = recorded.answer(image, chunk)
    else:
        actions = numpy.zeros((chunk, 7))
        actions[:, 0] = (count + numpy.arange(chunk)) / 1000
        actions[:, 6] = 1
        count += chunk
    if "bridge" in options:
        actions = conventions.to_bridge(actions)
    prefix = "" if form == "n1.6_nested" else "action."
    shape = (-1, 1) if form == "n1.5" else (1, -1, 1)
    answer = {prefix + name: actions[:, i].reshape(shape) for i, name in enumerate(NAMES)}
    return answer if form == "n1.5" else [answer, {}]


def reset(request):
    global count
    if form == "n1.5":
        raise ValueError("Unknown endpoint: reset")
    assert request["data"] == {"options": None}, request
    count = 0
    if recorded:
        recorded.reset()
    return {}


def answer(request):
    if "token" in options and request.get("api_token") != options["token"]:
        return {"error": f"Unauthorized: Invalid API token {request.get('api_token')}"}
    endpoint = request.get("endpoint", "get_action")
    if endpoint == "ping":
        return {"status": "ok", "message": "Server is running"}
    if endpoint == "reset":
        return reset(request)
    assert endpoint == "get_action", "Unknown endpoint: " + endpoint
    if form == "n1.5":
        return get_action(request["data"])
    assert set(request["data"]) == {"observation", "options"}
    return get_action(request["data"]["observation"])


def main():
    server = zmq.Context().socket(zmq.REP)
    port = server.bind_to_random_port("tcp://127.0.0.1")
    print("port", port, flush=True)
    os.close(1)
    while True:
        message = server.recv()
        if "record" in options:
            with open(options["record"], "a") as file:
                file.write(message.hex() + "\n")
        try:
            reply = answer(msgpack.unpackb(message, object_hook=decode))
        except Exception as error:
            reply = {"error": f"{type(error).__name__}: {error}"}
        server.send(msgpack.packb(reply, default=encode))


main()
