"""A server of the chat interface, POST /v1/chat/completions, with scripted models and faults; also
GET /v1/models and /health. The standard library alone.

chat_server.py MODEL [truth=FILE] [record=FILE] [logprobs=1] [delay=S] [key=KEY] [name=NAME]
               [fault=NAME] [on=TEXT] [first=N]

MODEL, a scripted model:
  oracle      knows by a side door: `truth` holds lines of JSON {"image", "text", "answer"}, with the
              SHA-256 of the picture's file in hex ("" without one) and all words that were sent
  always_a    says A
  copycat     repeats the instruction, that is what stands between the first quotes, else the question
  words_only  answers by a hash of the words, whatever is in the picture
What a model knows no answer to, it answers by a hash of picture and words.
`record` gets {"image", "text", "answer"} of every answer, a line each; `delay` seconds go by before
each; `key` has to be sent as a bearer token; `name` is what the model is called (MODEL).

FAULT, of questions that hold `on` (every one), and of each request the first `first` times (always):
  slow         waits 60 s
  busy         429 with Retry-After: 0.1
  error        500 with an error as JSON
  closes       closes without an answer
  cut          promises more than it sends
  text         200 with a text that is no JSON
  shape        JSON without choices
  null         content null
  thinks       content null, the answer in reasoning_content
  reasoning    the answer in content, thoughts apart in reasoning
  think_tags   the answer behind thoughts in tags
  unclosed     thoughts in a tag that does not end
  refusal      says that it cannot assist
  other_model  names another model than the one that was asked for
  stream       text/event-stream, though not asked for
  no_vision    400 on a request with a picture
  huge         an answer of 10 MB
  markup       controls, marks of direction and HTML around the answer
"""
import base64
import hashlib
import http.server
import json
import os
import re
import sys
import threading
import time

MODELS = ("oracle", "always_a", "copycat", "words_only")
script = sys.argv[1]
options = dict(word.split("=", 1) for word in sys.argv[2:])
name = options.get("name", script)
if script not in MODELS:
    sys.exit(f"chat_server.py: no model {script}")
truth = {}
if "truth" in options:
    with open(options["truth"], encoding="utf-8") as file:
        for line in file:
            entry = json.loads(line)
            truth[entry["image"], entry["text"]] = entry["answer"]
lock = threading.Lock()
attempts = {}  # of each request, by its body


# ---- models -------------------------------------------------------------------------------------

def draw(text):
    """A large number that only the text decides."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big")


def by_words(text):
    """An answer in the form that is asked for, drawn by the words."""
    value = draw(text)
    letters = re.findall(r"^([A-Z])[.)] ", text, re.M)
    if letters:
        return letters[value % len(letters)]
    if "yes or no" in text:
        return ("Yes", "No")[value % 2]
    if "whole number" in text:
        return str(value % 5)
    size = re.search(r"is (\d+) pixels wide and (\d+) high", text)
    if size:
        return f"({value % int(size[1])}, {value // 7 % int(size[2])})"
    words = re.findall(r"[a-z]{4,}", text) or ["it"]
    return f"Put the {words[value % len(words)]} on the {words[value // 7 % len(words)]}."


def instruction_in(text):
    quoted = re.search(r'"([^"]+)"', text)
    return quoted[1] if quoted else text.split("\n")[0]


def answer_of(image, text):
    if script == "always_a":
        return "A"
    if script == "copycat":
        return instruction_in(text)
    if script == "words_only":
        return by_words(text)
    return truth.get((image, text), f"unknown {draw(image + text) % 1000000}")


# ---- messages -----------------------------------------------------------------------------------

def asked_of(request):
    """Words of the last message and the SHA-256 of its picture."""
    content = request["messages"][-1]["content"]
    if isinstance(content, str):
        return content, ""
    text = "".join(part["text"] for part in content if part["type"] == "text")
    image = ""
    for part in content:
        if part["type"] == "image_url":
            url = part["image_url"]["url"]
            assert url.startswith("data:image/png;base64,"), url[:40]
            data = base64.b64decode(url.split(",", 1)[1], validate=True)
            assert data.startswith(b"\x89PNG\r\n\x1a\n")
            image = hashlib.sha256(data).hexdigest()
    return text, image


def likely_tokens(answer, wanted):
    """The answer's first letter before all others, each with a third of the one before."""
    first = answer[:1] or "A"
    others = [letter for letter in "ABCDEFGHIJKLMNOPQRST" if letter != first]
    tokens = ([first] + others)[:wanted]
    return [{"token": token, "logprob": -0.4 - 1.1 * i, "bytes": list(token.encode())}
            for i, token in enumerate(tokens)]


def completion(request, answer, **message):
    choice = {"index": 0, "message": {"role": "assistant", "content": answer} | message,
              "finish_reason": "stop", "logprobs": None}
    if "logprobs" in options and request.get("logprobs"):
        top = likely_tokens(answer or "", request.get("top_logprobs", 0))
        choice["logprobs"] = {"content": [top[0] | {"top_logprobs": top}]}
    prompt, words = len(str(request["messages"])) // 4, len((answer or "").split())
    return {"id": "chatcmpl-1", "object": "chat.completion", "created": int(time.time()),
            "model": request["model"], "choices": [choice], "system_fingerprint": "scripted-1",
            "usage": {"prompt_tokens": prompt, "completion_tokens": words,
                      "total_tokens": prompt + words}}


def error(message, kind="BadRequestError", code=400):
    return {"error": {"message": message, "type": kind, "param": None, "code": code}}


# ---- faults -------------------------------------------------------------------------------------

def slow(handler, request, answer):
    time.sleep(60)
    handler.reply(200, completion(request, answer))


def busy(handler, request, answer):
    handler.reply(429, error("too many requests", "RateLimitError", 429), {"Retry-After": "0.1"})


def failing(handler, request, answer):
    handler.reply(500, error("CUDA out of memory", "InternalServerError", 500))


def moved(handler, request, answer):
    handler.reply(307, error("moved", "Redirect", 307),
                  {"Location": "http://elsewhere:9000/v1/chat/completions?key=secret"})


def closes(handler, request, answer):
    handler.close_connection = True


def cut(handler, request, answer):
    body = json.dumps(completion(request, answer)).encode()
    handler.head(200, "application/json", len(body))
    handler.wfile.write(body[:len(body) // 2])
    handler.close_connection = True


def text(handler, request, answer):
    handler.reply(200, b"the model is thinking", {"Content-Type": "text/plain"})


def stream(handler, request, answer):
    chunk = {"object": "chat.completion.chunk", "choices": [{"delta": {"content": answer}}]}
    body = f"data: {json.dumps(chunk)}\n\ndata: [DONE]\n\n".encode()
    handler.reply(200, body, {"Content-Type": "text/event-stream"})


def no_vision(handler, request, answer):
    if asked_of(request)[1]:
        return handler.reply(400, error(f"{name} is not a multimodal model"))
    handler.reply(200, completion(request, answer))


def says(make):
    def fault(handler, request, answer):
        handler.reply(200, make(request, answer))
    return fault


FAULTS = {
    "slow": slow, "busy": busy, "moved": moved, "error": failing, "closes": closes, "cut": cut, "text": text,
    "stream": stream, "no_vision": no_vision,
    "shape": says(lambda request, answer: {"object": "list", "data": []}),
    "null": says(lambda request, answer: completion(request, None)),
    "thinks": says(lambda request, answer: completion(request, None, reasoning_content=answer)),
    "reasoning": says(lambda request, answer: completion(request, answer, reasoning="A? B? C?")),
    "think_tags": says(lambda request, answer: completion(
        request, f"<think>\nA? B? C?\n</think>\n\n{answer}")),
    "unclosed": says(lambda request, answer: completion(request, f"<think>\nit is {answer}")),
    "refusal": says(lambda request, answer: completion(
        request, "I'm sorry, but I can't assist with that.")),
    "other_model": says(lambda request, answer: completion(request, answer) | {"model": "other"}),
    "huge": says(lambda request, answer: completion(request, answer + "!" * (10 << 20))),
    "markup": says(lambda request, answer: completion(
        request, f"\x1b[31m\x00\u202e<b>{answer}</b>\n<script>alert(1)</script>\x07")),
}
fault = options.get("fault")
if fault is not None and fault not in FAULTS:
    sys.exit(f"chat_server.py: no fault {fault}")


def is_faulty(body, text):
    if fault is None or options.get("on", "") not in text:
        return False
    with lock:
        attempts[body] = attempts.get(body, 0) + 1
        return attempts[body] <= int(options.get("first", sys.maxsize))


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    wbufsize = -1

    def do_GET(self):
        if self.path == "/health":
            return self.reply(200, b"", {"Content-Type": "text/plain"})
        if self.path == "/v1/models":
            return self.reply(200, {"object": "list", "data": [{"id": name, "object": "model"}]})
        self.reply(404, error("not found", "NotFoundError", 404))

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path != "/v1/chat/completions":
            return self.reply(404, error("not found", "NotFoundError", 404))
        if "key" in options and self.headers["Authorization"] != f"Bearer {options['key']}":
            return self.reply(401, error("Unauthorized", "AuthenticationError", 401))
        try:
            request = json.loads(body)
            words, image = asked_of(request)
            assert request["stream"] is False
        except (ValueError, KeyError, TypeError, AssertionError) as problem:
            return self.reply(400, error(repr(problem)))
        if request["model"] != name:
            return self.reply(404, error(f"The model `{request['model']}` does not exist.",
                                         "NotFoundError", 404))
        time.sleep(float(options.get("delay", 0)))
        answer = answer_of(image, words)
        if is_faulty(body, words):
            return FAULTS[fault](self, request, answer)
        if "record" in options:
            line = json.dumps({"image": image, "text": words, "answer": answer}) + "\n"
            with lock, open(options["record"], "a", encoding="utf-8") as file:
                file.write(line)
        self.reply(200, completion(request, answer))

    def head(self, status, kind, size, more=()):
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(size))
        for key, value in more:
            self.send_header(key, value)
        self.end_headers()

    def reply(self, status, value, headers={}):
        body = value if isinstance(value, bytes) else json.dumps(value).encode()
        more = dict(headers)
        kind = more.pop("Content-Type", "application/json")
        self.head(status, kind, len(body), more.items())
        self.wfile.write(body)
        self.wfile.flush()

    def handle(self):
        try:
            super().handle()
        except ConnectionError:
            pass

    def log_message(self, *unused):
        pass


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 128


def main():
    server = Server(("127.0.0.1", 0), Handler)
    print("port", server.server_address[1], flush=True)
    os.close(1)
    server.serve_forever()


main()
