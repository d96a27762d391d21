"""examples/serve_simpler.py with a policy that follows recorded actions, or one that fails.

shim_server.py actions=FILE [object]     a policy a connection, or one object for all
shim_server.py fails
shim_server.py batches                   a policy that keeps nothing and takes several pictures
"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "../../examples"))
sys.dont_write_bytecode = True

import serve_simpler  # noqa: E402

import recorded_actions  # noqa: E402


class SimplerPolicy:
    """The manner of SimplerEnv's policies."""

    def __init__(self):
        self.recorded = recorded_actions.RecordedPolicy(EPISODES)

    def reset(self, task_description):
        assert isinstance(task_description, str)
        self.recorded.reset()

    def step(self, image, task_description, eef_pos=None):
        assert eef_pos.shape == (8,)
        numbers = self.recorded.answer(image, 1)[0]
        raw = {"world_vector": numbers[:3], "rotation_delta": numbers[3:6],
               "open_gripper": numbers[6:]}
        action = {"world_vector": numbers[:3], "rot_axangle": numbers[3:6], "gripper": numbers[6:],
                  "terminate_episode": [0]}
        return raw, action


class BatchPolicy:
    def reset(self, task_description):
        pass

    def step(self, image, task_description):
        x = (int(image[0, 0, 0]) + len(task_description)) / 1000
        return {}, {"world_vector": [x, 0, 0], "rot_axangle": [0, 0, 0], "gripper": [1]}

    def step_batch(self, images, tasks):
        return [self.step(image, task) for image, task in zip(images, tasks)]


class FailingPolicy:
    def reset(self, task_description):
        pass

    def step(self, image, task_description):
        raise ValueError("no such key")


if sys.argv[1] == "fails":
    serve_simpler.serve(FailingPolicy(), 0)
if sys.argv[1] == "batches":
    serve_simpler.serve(BatchPolicy(), 0)
EPISODES = recorded_actions.load(sys.argv[1].partition("=")[2])
serve_simpler.serve(SimplerPolicy() if "object" in sys.argv else SimplerPolicy, 0)
