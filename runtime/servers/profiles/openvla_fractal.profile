# openvla/openvla-7b on the Google robot (RT-1's data, fractal20220817_data), for scenes of suite/google, as SimplerEnv's fork for
# OpenVLA evaluates it (DelinQu/SimplerEnv-OpenVLA, also simpler_env/policies/openvla of SimplerEnv):
#   openvla://HOST:PORT?profile=openvla_fractal
# but for the words, which that class sends bare and this server puts into its own sentence.
# Pictures are made 224 x 224 by area; roll, pitch and yaw are turned into a rotation; a switch of the gripper is held for 15 steps.
protocol = openvla
about = OpenVLA 7B on the Google robot behind its REST server
unnorm_key = fractal20220817_data
image = first -> image 224x224 cv2_area
prompt.key = instruction
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.sticky = last
action.sticky_steps = 15
chunk.length = 1
timeout.connect_s = 60
timeout.wait_s = 60
