"""evaluate.py PLAN OUT [--shards N] [--gpus G]: a policy of one's own over a Ray cluster, a shard a task, merged.

Ray starts and restarts tasks; vlaprobe knows which episodes are there. A task that Ray starts again, since its node went
away, continues its shard. OUT is a folder that all nodes can write. Without Ray, or with --local, shards run one after
the other here.
"""
import argparse
import os
import subprocess

import numpy
import vlaprobe


class StandStill:
    """Stands in for a policy: loaded once a shard, asked for all worlds that wait at once."""

    def __call__(self, batch):
        actions = numpy.zeros((len(batch["prompt"]), 7))
        actions[:, 6] = 1  # the gripper stays open
        return actions


def evaluate_shard(plan, out, starts):
    """The given starts of every task."""
    run = vlaprobe.evaluate(StandStill(), plan, name="stand_still", content="1", episodes=starts, out=out, progress=False)
    return len(run.results())


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("plan")
    words.add_argument("out")
    words.add_argument("--shards", type=int, default=8)
    words.add_argument("--gpus", type=float, default=0, help="of each shard's policy")
    words.add_argument("--local", action="store_true", help="without Ray")
    words.add_argument("--program", default="vlaprobe", help="that merges")
    given = words.parse_args()
    out = os.path.abspath(given.out)
    plan = os.path.abspath(given.plan)
    starts = max(task.episodes for task in vlaprobe.load(plan).tasks.values())
    cuts = [starts * i // given.shards for i in range(given.shards + 1)]
    parts = [(first, end - 1) for first, end in zip(cuts, cuts[1:]) if end > first]
    folders = [os.path.join(out, "shards", f"{i}-of-{len(parts)}") for i in range(1, len(parts) + 1)]
    calls = [(plan, folder, part) for folder, part in zip(folders, parts)]
    if given.local:
        done = [evaluate_shard(*call) for call in calls]
    else:
        import ray

        ray.init()
        task = ray.remote(num_cpus=1, num_gpus=given.gpus, max_retries=3)(evaluate_shard)
        done = ray.get([task.remote(*call) for call in calls])
    subprocess.run([given.program, "merge", *folders, "-o", out], check=True)
    print(sum(done), "episodes in", out)


if __name__ == "__main__":
    main()
