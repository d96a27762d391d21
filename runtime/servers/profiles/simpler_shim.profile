# A policy of SimplerEnv's manner (reset(task), step(image, task)) behind
# examples/serve_simpler.py:
#   openpi://HOST:PORT?profile=simpler_shim
# Its actions are the simulator's own: metres, rotation vector, gripper -1 or +1. A new connection
# is a new episode there, and each answer holds one action.
protocol = openpi
about = a SimplerEnv policy behind examples/serve_simpler.py
image = first -> observation/image
prompt.key = prompt
state.key = observation/state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
chunk.length = 1
connection = per_episode
timeout.connect_s = 60
timeout.wait_s = 60
