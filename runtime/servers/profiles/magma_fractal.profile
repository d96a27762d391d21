# Magma for scenes of suite/google: MagmaInference(model_name, "google_robot") of Magma's tools/simplerenv-magma, behind examples/serve_simpler.py.
#   openpi://HOST:PORT?profile=magma_fractal
# Magma's class does the rest, before it answers: pictures, statistics, rotation, the gripper's rule. Its gripper closes at +1 and says
# how far to go; each answer holds one action. Its `reset` forgets the words alone: have the wrapper forget what it keeps of the gripper,
# too, or results depend on the order of episodes.
protocol = openpi
about = Magma on the Google robot behind examples/serve_simpler.py
image = first -> observation/image
prompt.key = prompt
state.key = observation/state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
action.gripper = step_inverted
chunk.length = 1
connection = per_episode
timeout.connect_s = 60
timeout.wait_s = 60
