"""A server that speaks LeRobot's asynchronous inference as its policy_server.py does: one place for an
observation, one policy for all, pickles both ways. PyTorch's tensors are written by hand.

lerobot_server.py [chunk=N] [record=FILE] [lacks=MODEL] [dies_of=MODEL] [port=N] [seen] [arrivals] [impatient]

Answers chunks of N actions whose first number is the count of actions answered so far / 1000, or, with
`seen`, small ones that follow from what was asked and which model is loaded.
`record` gets a line of JSON for each call, with `arrivals` also when actions are asked for and when an
observation has arrived. With `impatient` who asks before there is one gets nothing at once. The model `lacks`
cannot be loaded, and `dies_of` ends the server. An instruction
"fault:NAME" makes that answer fail as named in FAULTS.
"""
import hashlib
import json
import os
import pickle
import struct
import sys
import time
import types
from concurrent import futures
from queue import Empty, Queue

import grpc
import numpy

options = dict(word.split("=", 1) if "=" in word else (word, "") for word in sys.argv[1:])
SERVICE = "/transport.AsyncInference/"


# ---- classes and functions by the names that pickles have for them --------------------------------

def module(name, **members):
    made = types.ModuleType(name)
    sys.modules[name] = made
    for member, value in members.items():
        value.__module__ = name
        setattr(made, member, value)


class RemotePolicyConfig:
    pass


class TimedObservation:
    pass


class TimedAction:
    def __init__(self, timestamp, timestep, action):
        self.timestamp, self.timestep, self.action = timestamp, timestep, action


def _rebuild_tensor_v2(*arguments):
    raise RuntimeError("no client sends tensors")


def _load_from_bytes(data):
    raise RuntimeError("no client sends storages")


class FloatStorage:
    pass


module("lerobot")  # a name's first part is imported, too
module("lerobot.async_inference.helpers", RemotePolicyConfig=RemotePolicyConfig,
       TimedObservation=TimedObservation, TimedAction=TimedAction)
module("torch", FloatStorage=FloatStorage)
module("torch._utils", _rebuild_tensor_v2=_rebuild_tensor_v2)
module("torch.storage", _load_from_bytes=_load_from_bytes)


class Reference(tuple):
    """Of a storage, as torch.save names it."""


class StoragePickler(pickle._Pickler):
    def persistent_id(self, thing):
        return tuple(thing) if isinstance(thing, Reference) else None


class Storage:
    def __init__(self, numbers, place="cpu"):
        self.numbers, self.place = numbers, place

    def __reduce__(self):
        import io
        out = io.BytesIO()
        for part in (0x1950a86a20f9469cfc6c, 1001,
                     {"protocol_version": 1001, "little_endian": True,
                      "type_sizes": {"short": 2, "int": 4, "long": 4}},
                     Reference(("storage", FloatStorage, "0", self.place, len(self.numbers),
                                None)), ["0"]):
            StoragePickler(out, 2).dump(part)
        out.write(struct.pack(f"<q{len(self.numbers)}f", len(self.numbers), *self.numbers))
        return _load_from_bytes, (out.getvalue(),)


class Tensor:
    """A row of a larger one, as the server's are."""

    def __init__(self, storage, offset, size):
        self.parts = storage, offset, size

    def __reduce__(self):
        import collections
        storage, offset, size = self.parts
        return _rebuild_tensor_v2, (storage, offset, (size,), (1,), False,
                                    collections.OrderedDict())


def timed(observation, rows, place="cpu", late=0):
    storage = Storage([number for row in rows for number in row], place)
    actions, offset = [], 0
    for i, row in enumerate(rows):
        actions.append(TimedAction(observation.timestamp + i / 30, observation.timestep + late + i,
                                   Tensor(storage, offset, len(row))))
        offset += len(row)
    return actions


# ---- faults -----------------------------------------------------------------------------------------

GOOD = [0.0, 0, 0, 0, 0, 0, 1]


class Evil:
    def __reduce__(self):
        return os.system, ("touch /tmp/vlaprobe_was_run",)


def never(observation):
    time.sleep(60)


def slow(observation):
    time.sleep(0.15)
    return pickle.dumps(timed(observation, [GOOD]))


def dumps(make):
    return lambda observation: pickle.dumps(make(observation))


FAULTS = {
    "never": never,
    "slow": slow,
    "shape": dumps(lambda o: timed(o, [GOOD[:6]])),
    "nan": dumps(lambda o: timed(o, [[0.0, float("nan"), 0, 0, 0, 0, 1]])),
    "far": dumps(lambda o: timed(o, [[1000.0, 0, 0, 0, 0, 0, 1]])),
    "other": dumps(lambda o: {"values": 1}),
    "others": dumps(lambda o: [1, 2]),
    "late": dumps(lambda o: timed(o, [GOOD], late=1)),
    "huge": lambda o: bytes(2 << 20),
    "garbage": lambda o: bytes(range(1, 200)),
    "half": lambda o: pickle.dumps(timed(o, [GOOD]))[:-20],
    "twice": lambda o: pickle.dumps(timed(o, [GOOD])) * 2,
    "empty": lambda o: b"",
    "none": dumps(lambda o: []),
    "cuda": dumps(lambda o: timed(o, [GOOD], place="cuda:0")),
    "evil": dumps(lambda o: [Evil()]),
}


# ---- the server -------------------------------------------------------------------------------------

def fields(message):
    """Of a protobuf message with numbers and bytes."""
    found, at = {}, 0

    def varint():
        nonlocal at
        value = shift = 0
        while True:
            byte = message[at]
            at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    while at < len(message):
        key, value = varint(), varint()
        if key & 7 == 2:
            at += value
            value = message[at - value:at]
        found[key >> 3] = value
    return found


def with_bytes(data):
    size, head = len(data), b"\x0a"
    if not data:
        return b""
    while size > 127:
        head += bytes([size & 127 | 128])
        size >>= 7
    return head + bytes([size]) + data


class Server(grpc.GenericRpcHandler):
    def __init__(self):
        self.queue, self.config, self.answered = Queue(1), None, 0

    def note(self, call, **more):
        if "record" in options:
            with open(options["record"], "a") as file:
                file.write(json.dumps({"call": call, **more}) + "\n")

    def service(self, details):
        call = details.method.removeprefix(SERVICE)
        if call == "SendObservations":
            return grpc.stream_unary_rpc_method_handler(self.observe)
        if call in ("Ready", "SendPolicyInstructions", "GetActions"):
            return grpc.unary_unary_rpc_method_handler(
                {"Ready": self.ready, "SendPolicyInstructions": self.load,
                 "GetActions": self.act}[call])
        return None

    def ready(self, message, context):
        self.note("Ready")
        self.queue = Queue(1)
        return b""

    def load(self, message, context):
        config = pickle.loads(fields(message)[1])
        assert isinstance(config, RemotePolicyConfig)
        self.note("SendPolicyInstructions", **vars(config))
        if config.pretrained_name_or_path == options.get("lacks"):
            raise FileNotFoundError("no model at " + config.pretrained_name_or_path)
        if config.pretrained_name_or_path == options.get("dies_of"):
            os._exit(1)
        self.config = config
        return b""

    def observe(self, messages, context):
        data = b""
        for part in map(fields, messages):
            data = part[2] if part[1] == 1 else data + part[2]
            if part[1] == 3:
                break
        observation = pickle.loads(data)
        assert isinstance(observation, TimedObservation)
        if observation.must_go:
            if self.queue.full():
                self.queue.get_nowait()
            if "arrivals" in options:
                time.sleep(0.02)  # so that whoever does not wait for it is there first
                self.note("arrived")
            self.queue.put(observation)
        return b""

    def act(self, message, context):
        if "arrivals" in options:
            self.note("asked")
        try:
            observation = self.queue.get(timeout=0.001 if "impatient" in options else 2)
        except Empty:
            return b""
        raw = observation.observation
        task = raw["task"]
        seen = {key: [str(value.dtype), list(value.shape), int(value.sum())]
                if isinstance(value, numpy.ndarray) else value for key, value in raw.items()}
        self.note("GetActions", step=observation.timestamp, **seen)
        if task == "fault:gone":
            os._exit(1)
        if task == "fault:traceback":
            raise KeyError("x")
        try:
            # As build_dataset_frame takes an observation apart.
            for feature, kind in self.config.lerobot_features.items():
                if kind["dtype"] == "image":
                    assert list(raw[feature.removeprefix("observation.images.")].shape) == list(
                        kind["shape"])
                else:
                    numpy.array([raw[name] for name in kind["names"]], dtype=numpy.float32)
            if task.startswith("fault:"):
                data = FAULTS[task[6:]](observation)
            else:
                rows = []
                if "seen" in options:
                    seen = repr(seen) + self.config.pretrained_name_or_path
                    first = hashlib.sha256(seen.encode()).digest()[0] / 20000
                for _ in range(min(int(options.get("chunk", 1)), self.config.actions_per_chunk)):
                    rows.append([first if "seen" in options else self.answered / 1000] + GOOD[1:])
                    self.answered += 1
                data = pickle.dumps(timed(observation, rows))
            return with_bytes(data)
        except Exception as error:  # as the real one: said in its log alone
            print(repr(error), file=sys.stderr)
            return b""


server = grpc.server(futures.ThreadPoolExecutor(max_workers=4), handlers=[Server()],
                     options=[("grpc.so_reuseport", 0)])
print("port", server.add_insecure_port("127.0.0.1:" + options.get("port", "0")), flush=True)
os.close(1)
server.start()
server.wait_for_termination()
