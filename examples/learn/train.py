"""Behaviour cloning from what `vlaprobe export --format robomimic` wrote, and from nothing else.

    python3 examples/learn/train.py DATASET... -o FOLDER [--minutes 12] [--checkpoints 3]

Learns until it has used so many minutes of processor time, and keeps a checkpoint after equal shares of them.
"""
import argparse
import json
import pathlib
import random
import time

import h5py
import numpy
import torch
from torch.nn import functional as F

from policy import CHUNK, Learnt, hand_of, save, words_of

REST = 4  # frames that are kept of the standing still at a demonstration's end


def demonstrations(folders):
    """One each, however many wordings tell it: pictures, states, actions, wordings."""
    told = {}
    for folder in folders:
        with h5py.File(pathlib.Path(folder) / "demos.hdf5") as file:
            for demo in file["data"].values():
                key = str(folder), h5py.h5o.get_info(demo["actions"].id).addr
                words = json.loads(demo.attrs["ep_meta"])["lang"]
                if key in told:  # its datasets are links to the same bytes
                    told[key][3].append(words)
                    continue
                actions = demo["actions"][:]
                moves = numpy.flatnonzero(numpy.abs(actions[:, :6]).max(1) > 1e-6)
                n = min(len(actions), (moves[-1] if len(moves) else 0) + 1 + REST)
                camera = next(name for name in demo["obs"] if demo["obs"][name].ndim == 4)
                told[key] = demo["obs"][camera][:n], demo["obs/state"][:n], actions[:n], [words]
    return list(told.values())


def labels(hand, actions):
    """Where this hand closes and opens later: [n, 12], and for each number whether that is to come."""
    n, grip = len(actions), actions[:, 6]
    closes = int(numpy.argmax(grip < 0)) if (grip < 0).any() else n - 1
    opens = closes + int(numpy.argmax(grip[closes:] > 0)) if (grip[closes:] > 0).any() else n - 1
    where = torch.cat([hand[closes, :9], hand[opens, :3]]).repeat(n, 1)
    steps = torch.arange(n)[:, None]
    return where, torch.cat([(steps <= closes).expand(n, 9), (steps <= opens).expand(n, 3)], 1).float()


def frames(demos):
    """All demonstrations behind one another: tensors over frames."""
    columns = []
    for number, (pictures, states, actions, _) in enumerate(demos):
        hand = hand_of(torch.tensor(states, dtype=torch.float32))
        rows = numpy.minimum(numpy.arange(len(actions))[:, None] + numpy.arange(CHUNK), len(actions) - 1)
        where, is_known = labels(hand, actions)
        chunk = torch.tensor(actions[rows], dtype=torch.float32)
        changes = (chunk[:, :, 6].max(1).values != chunk[:, :, 6].min(1).values).float()
        columns.append((torch.from_numpy(pictures), hand, chunk, where, is_known, 1 + changes,
                        torch.full((len(actions),), number)))
    return [torch.cat(column) for column in zip(*columns)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("datasets", nargs="+")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--minutes", type=float, default=12, help="of processor time")
    parser.add_argument("--checkpoints", type=int, default=3)
    parser.add_argument("--batch", type=int, default=64)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=2)
    args = parser.parse_args()
    torch.manual_seed(args.seed)
    random.seed(args.seed)
    torch.set_num_threads(args.threads)
    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)

    demos = demonstrations(args.datasets)
    told = [sorted(demo[3]) for demo in demos]
    pictures, hand, actions, where, is_known, weight, owner = frames(demos)
    policy = Learnt(sorted({word for words in told for text in words for word in words_of(text)}))
    policy.hand_mean, policy.hand_std = hand.mean(0), hand.std(0) + 1e-3
    policy.place_mean, policy.place_std = where.mean(0), where.std(0) + 1e-3
    policy.action_std = actions.reshape(-1, 7).abs().mean(0) + 1e-4
    numbers = [[policy.numbers(text) for text in words] for words in told]
    print(f"{len(demos)} demonstrations, {len(owner)} frames, {sum(len(set(w)) for w in told)} tellings, "
          f"{len({t for w in told for t in w})} instructions, {len(policy.number)} words", flush=True)

    optimizer = torch.optim.AdamW(policy.parameters(), lr=1e-3, weight_decay=1e-4)
    begun, step, kept, losses = time.process_time(), 0, 0, []
    while kept < args.checkpoints:
        done = (time.process_time() - begun) / 60 / args.minutes
        optimizer.param_groups[0]["lr"] = 1e-3 * min(1, (step + 1) / 100) * (1 - 0.97 * min(done, 1))
        rows = torch.randint(len(owner), (args.batch,))
        # A word in twenty is unheard: so that one never read is no surprise.
        said = [[0 if random.random() < 0.05 else w for w in random.choice(numbers[i])] for i in owner[rows].tolist()]
        found, places = policy(pictures[rows], hand[rows], policy.read(said))
        wrong = ((found - actions[rows] / policy.action_std).abs().mean((1, 2)) * weight[rows]).mean()
        astray = (F.smooth_l1_loss(places, (where[rows] - policy.place_mean) / policy.place_std, beta=0.1,
                                   reduction="none") * is_known[rows]).mean()
        optimizer.zero_grad()
        (wrong + 3 * astray).backward()
        torch.nn.utils.clip_grad_norm_(policy.parameters(), 1)
        optimizer.step()
        losses.append((wrong.item(), astray.item()))
        step += 1
        if step % 200 == 0:
            spent = (time.process_time() - begun) / 60
            print(f"step {step}, {step * args.batch / len(owner):.1f} epochs, {spent:.1f} min: actions "
                  f"{numpy.mean(losses, 0)[0]:.3f}, places {numpy.mean(losses, 0)[1]:.4f}", flush=True)
            losses = []
        if (time.process_time() - begun) / 60 >= args.minutes * (kept + 1) / args.checkpoints:
            kept += 1
            save(policy, out / f"part_{kept}.pt")
    print(f"{step} steps, {(time.process_time() - begun) / 60:.1f} minutes of processor time in {out}")


if __name__ == "__main__":
    main()
