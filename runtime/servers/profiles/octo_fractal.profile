# Octo for scenes of suite/google: OctoInference(model_type="octo-base", policy_setup="google_robot") behind examples/serve_simpler.py.
#   openpi://HOST:PORT?profile=octo_fractal
# SimplerEnv's class does the rest, before it answers: pictures, statistics, rotation, the gripper's rule. Its gripper closes at +1 and
# says how far to go; each answer holds one action, and a new connection is a new episode there.
protocol = openpi
about = Octo on the Google robot behind examples/serve_simpler.py
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
