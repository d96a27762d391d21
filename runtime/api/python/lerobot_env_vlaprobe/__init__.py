"""vlaprobe's tasks in LeRobot: ``lerobot-eval --env.type=vlaprobe --env.task=carrot_on_plate --policy.path=...``

LeRobot imports every installed distribution whose name begins with lerobot_env_; this one registers an EnvConfig.
"""

from dataclasses import dataclass

import vlaprobe
from lerobot.configs import FeatureType, PolicyFeature
from lerobot.envs import EnvConfig
from lerobot.utils.constants import ACTION, OBS_IMAGES, OBS_STATE, OBS_STR
from vlaprobe.lerobot import LeRobotVectorEnv, make_envs


@EnvConfig.register_subclass("vlaprobe")
@dataclass
class VlaprobeEnv(EnvConfig):
    """Tasks of a plan.

    Attributes:
        task: a glob over names; each is a group of its own in eval_info.json.
        plan: path of a .plan or .probe file; "": the suite `intact` that comes with vlaprobe.
        observation_width, observation_height: of the pictures, both; 0: each camera's own. As the dataset has it that the
            policy was trained on (``vlaprobe export --size``).
        threads: that step the worlds; 0: one a core.
    """

    task: str | None = "*"
    plan: str = ""
    observation_width: int = 0
    observation_height: int = 0
    threads: int = 0

    def __post_init__(self):
        plan = self._load()
        tasks = plan.select(self.task or "*")
        worlds = LeRobotVectorEnv(plan, tasks[0], num_envs=1, **self.gym_kwargs)
        self.fps = worlds.metadata["render_fps"]
        spaces = worlds.single_observation_space
        self.features = {ACTION: PolicyFeature(FeatureType.ACTION, worlds.single_action_space.shape)}
        self.features_map = {ACTION: ACTION, "agent_pos": OBS_STATE, "joints": f"{OBS_STR}.joints"}
        for key in ("agent_pos", "joints"):
            self.features[key] = PolicyFeature(FeatureType.STATE, spaces[key].shape)
        for camera, space in spaces["pixels"].spaces.items():
            key = f"{OBS_IMAGES}.{camera}"
            self.features[key] = PolicyFeature(FeatureType.VISUAL, space.shape)
            self.features_map[key] = key
        worlds.close()

    @property
    def gym_kwargs(self) -> dict:
        return {
            "width": self.observation_width or None,
            "height": self.observation_height or None,
            "threads": self.threads,
        }

    def create_envs(self, n_envs: int, use_async_envs: bool = False) -> dict:
        """{task: {0: worlds}}. The worlds are stepped by threads either way."""
        return make_envs(self._load(), self.task or "*", n_envs, **self.gym_kwargs)

    def _load(self) -> vlaprobe.Plan:
        return vlaprobe.load(self.plan or vlaprobe.suite_file())
