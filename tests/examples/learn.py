"""examples/learn from demonstrations to an evaluation, small: python3 learn.py VLAPROBE FOLDER.

Prints a line for each thing that holds; exits with 77 where PyTorch or h5py is missing.
"""
import json
import pathlib
import subprocess
import sys

try:
    import h5py
    import numpy
    import torch
except ImportError as error:
    print(error)
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/learn"
VLAPROBE, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
sys.dont_write_bytecode = True
sys.path.insert(0, str(EXAMPLE))

import policy  # noqa: E402
import train  # noqa: E402


def vlaprobe(*arguments):
    done = subprocess.run([VLAPROBE, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def hands_are_their_rotations():
    state = torch.tensor([[0.3, 0.1, 0.2, 0.4, 1.2, -2.0, 1.0]], dtype=torch.float64)
    r, p, y = state[0, 3:6]
    x, z = torch.tensor([1.0, 0, 0]).double(), torch.tensor([0, 0, 1.0]).double()

    def turn(axis, angle):
        k = torch.zeros(3, 3).double()
        k[0, 1], k[0, 2], k[1, 2] = -axis[2], axis[1], -axis[0]
        return torch.matrix_exp((k - k.T) * angle)

    whole = turn(z, y) @ turn(torch.tensor([0, 1.0, 0]).double(), p) @ turn(x, r)
    assert torch.allclose(policy.hand_of(state)[0, 3:9], whole[:, :2].T.reshape(-1))
    print("rotation")


def learns_and_is_served():
    text, suite = EXAMPLE / "tasks.probe", ROOT / "suite/intact.probe"
    vlaprobe("rephrase", text, "--suite", "learn", "--not-in", suite, "--drop-leaks", "-o",
             FOLDER / "words.jsonl")
    vlaprobe("demos", text, "--suite", "learn", "--tasks", "carrot_plate", "--episodes", "0-3", "--noise", "0.005",
             "-o", FOLDER / "demos")
    vlaprobe("export", FOLDER / "demos", "--format", "robomimic", "--size", "128x96", "-o", FOLDER / "data",
             "--rephrase", FOLDER / "words.jsonl", "--wordings", "3")
    demos = train.demonstrations([FOLDER / "data"])
    assert len(demos) >= 2 and all(len(told) == 3 for *_, told in demos)
    print("told")
    # What nobody labelled: until the hand closes, where it will; what it holds is in it, and stays where it let go.
    _, states, actions, _ = demos[0]
    hand = policy.hand_of(torch.tensor(states))
    where = train.labels(hand, actions)
    closes = int((actions[:, 6] < 0).argmax())
    opens = closes + int((actions[closes:, 6] > 0).argmax())
    assert 0 < closes < opens < len(actions) - 1
    assert (where[:closes, :9] == hand[closes, :9]).all() and (where[opens:, :9] == hand[opens, :9]).all()
    assert (where[closes:opens, :9] == hand[closes:opens, :9]).all() and (where[:, 9:] == hand[opens, :3]).all()
    print("labelled")

    subprocess.run([sys.executable, EXAMPLE / "train.py", FOLDER / "data", "-o", FOLDER / "policies", "--minutes",
                    "0.05", "--checkpoints", "2", "--batch", "8", "--threads", "1"], check=True, stdout=subprocess.DEVNULL)
    server = subprocess.Popen([sys.executable, EXAMPLE / "serve.py", FOLDER / "policies", "--port", "0"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        port = server.stdout.readline().split()[1]
        vlaprobe("run", suite, "--tasks", "carrot_on_plate", "--episodes", "0-1", "--seeds", "42", "--jobs", "2",
                 "-o", FOLDER / "run", "--policy", f"ws://127.0.0.1:{port}/part_2?profile={EXAMPLE}/learnt.profile&batch=2")
    finally:
        server.kill()
        server.wait()
    rows = json.loads(vlaprobe("results", FOLDER / "run", "--json"))
    assert len(rows) == 2 and not any(row["invalid"] for row in rows), rows
    print("valid")

    # The pictures, states and words that it was asked with are those that an export of its run has.
    vlaprobe("export", FOLDER / "run", "--format", "robomimic", "--size", "128x96", "-o", FOLDER / "seen")
    learnt = policy.load(FOLDER / "policies/part_2.pt")
    for pictures, states, actions, told in train.demonstrations([FOLDER / "seen"]):
        for step in range(0, 20, 2):  # two of each answer are done
            again = learnt.act(torch.from_numpy(pictures[step:step + 1]), torch.tensor(states[step:step + 1]), told)
            off = numpy.abs(again[0, :2].numpy() - actions[step:step + 2])
            assert off[:, :6].max() < 1e-5, (step, off)
    print("same")


hands_are_their_rotations()
learns_and_is_served()
