# RT-1-X for scenes of suite/google: RT1Inference(saved_model_path="rt_1_x_tf_trained_for_002272480_step") behind examples/serve_simpler.py.
#   openpi://HOST:PORT?profile=rt1x_fractal
# SimplerEnv's class does the rest, before it answers: pictures, statistics, rotation, the gripper's rule. Its gripper closes at +1 and
# says how far to go; each answer holds one action, and a new connection is a new episode there.
protocol = openpi
about = RT-1-X on the Google robot behind examples/serve_simpler.py
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
