"""A server that speaks OpenVLA's protocol as its deploy.py does: POST /act, and "error" with status
200 for whatever goes wrong.

openvla_server.py [actions=FILE] [bridge=1] [chunk=N] [unnorm_key=KEY] [record=FILE]

Answers recorded actions, or one whose first number is the count so far / 1000; with `bridge` in
BridgeData's convention. With `unnorm_key` requests need that one.
`record` gets every request's body, a line each.
"""
import base64
import http.server
import json
import os
import sys

import numpy

import conventions
import recorded_actions

options = dict(word.split("=", 1) for word in sys.argv[1:])
chunk = int(options.get("chunk", 1))
episodes = recorded_actions.load(options["actions"]) if "actions" in options else None
recorded = recorded_actions.RecordedPolicy(episodes) if episodes else None
count = 0


def default(obj):
    """json_numpy.default."""
    if isinstance(obj, (numpy.ndarray, numpy.generic)):
        return {"__numpy__": base64.b64encode(obj.tobytes()).decode(), "dtype": obj.dtype.str,
                "shape": obj.shape}
    raise TypeError(type(obj))


def hook(obj):
    if "__numpy__" in obj:
        data = base64.b64decode(obj["__numpy__"])
        return numpy.frombuffer(data, obj["dtype"]).reshape(obj["shape"])
    return obj


def predict(payload):
    global count
    image, instruction = payload["image"], payload["instruction"]
    assert image.dtype == numpy.uint8 and image.ndim == 3 and isinstance(instruction, str)
    assert payload.get("unnorm_key") == options.get("unnorm_key"), "no such statistics"
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
    return actions if chunk > 1 else actions[0]


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_GET(self):
        self.reply(404, {"detail": "Not Found"})

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path != "/act":
            return self.reply(404, {"detail": "Not Found"})
        if "record" in options:
            with open(options["record"], "ab") as file:
                file.write(body + b"\n")
        try:
            payload = json.loads(body, object_hook=hook)
            double_encode = "encoded" in payload
            if double_encode:
                payload = json.loads(payload["encoded"], object_hook=hook)
            action = predict(payload)
            self.reply(200, json.dumps(action, default=default) if double_encode else action)
        except Exception:
            self.reply(200, "error")

    def reply(self, status, value):
        body = json.dumps(value, default=default).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *unused):
        pass


def main():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    print("port", server.server_address[1], flush=True)
    os.close(1)
    server.serve_forever()


main()
