# What lerobot:// does without profile=: a policy behind LeRobot's asynchronous server
# (python -m lerobot.async_inference.policy_server), one picture and the end effector's pose.
#   lerobot://HOST:PORT?type=smolvla&model=PATH&device=cuda
# Pictures and state are named as the features that the policy was trained on; the server resizes
# pictures itself. What the actions mean is the policy's: say it.
protocol = lerobot
about = a LeRobot policy server; actions' meaning is to be said
image = first -> observation.images.image
prompt.key = task
state.key = observation.state
state.layout = xyz_rpy_openness
timeout.connect_s = 60
timeout.wait_s = 60
