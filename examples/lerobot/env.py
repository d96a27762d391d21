"""vlaprobe's tasks as an environment of the Hub (LeRobot's EnvHub): push this file, and a .plan or .probe file of your own as
suite.plan beside it, into a repository USER/NAME; then

    lerobot-eval --env.type=... --env.hub_path=USER/NAME --trust_remote_code=true --env.task=carrot_on_plate --policy.path=...

or make_env("USER/NAME", trust_remote_code=True) in Python. Without a suite.plan the tasks are those of `intact`.
"""

import os

import vlaprobe
from vlaprobe.lerobot import make_envs


def make_env(n_envs=1, use_async_envs=False, cfg=None):
    """{task: {0: worlds}}, of the tasks that cfg.task means, or of all."""
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "suite.plan")
    plan = own if os.path.exists(own) else vlaprobe.suite_file()
    return make_envs(plan, getattr(cfg, "task", None) or "*", n_envs)
