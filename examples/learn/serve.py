#!/usr/bin/env python3
"""Serves checkpoints of train.py through the shim for SimplerEnv's manner.

    python3 examples/learn/serve.py FOLDER --port 8000
    vlaprobe run suite/intact.probe -o runs/learnt \\
      --policy 'ws://127.0.0.1:8000/part_3?profile=examples/learn/learnt.profile&batch=8' --jobs 8

The address's path names the checkpoint, so one server does a whole sweep.
"""
import argparse
import functools
import pathlib
import sys

import numpy
import torch

from policy import load

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import serve_simpler  # noqa: E402


class Served:
    """Keeps nothing between steps, so that one pass answers all worlds that wait."""

    def __init__(self, policy):
        self.policy = policy

    def reset(self, task):
        pass

    def step(self, image, task, eef_pos):
        return self.step_batch([image], [task], [eef_pos])[0]

    def step_batch(self, images, tasks, eef_pos):
        pictures, states = (torch.from_numpy(numpy.stack(rows)) for rows in (images, eef_pos))
        actions = self.policy.act(pictures, states, tasks).numpy()
        return [({}, {"world_vector": a[:, :3], "rot_axangle": a[:, 3:6], "gripper": a[:, 6]}) for a in actions]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="serve checkpoints to vlaprobe")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--port", type=int, default=8000)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    torch.set_num_threads(args.threads)

    @functools.lru_cache(None)
    def checkpoint(path):
        return Served(load(args.folder / f"{pathlib.PurePath(path).name}.pt"))

    serve_simpler.serve(checkpoint, args.port)
