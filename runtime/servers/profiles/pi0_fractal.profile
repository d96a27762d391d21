# pi0 on the Google robot (RT-1's data, fractal20220817_data) behind openpi's own server, for scenes of suite/google:
#   openpi://HOST:PORT?profile=pi0_fractal
# openpi ships no config for that data: keys, picture and state are those of SimplerEnv's client for LeRobot's pi0
# (simpler_env/policies/lerobotpi): 224 x 224 by area; the state is place, quaternion x y z w and how closed the gripper is; 4 actions
# of an answer are done; a switch of the gripper is held for 10 steps. Where yours has other names, copy this file and change the keys.
protocol = openpi
about = pi0 on the Google robot behind openpi's server, raw actions of RT-1's data
image = first -> observation.images.image 224x224 cv2_area
prompt.key = prompt
state.key = observation.state
state.layout = xyz_xyzw_closedness
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.sticky = switch
action.sticky_steps = 10
chunk.use = 4
timeout.connect_s = 60
timeout.wait_s = 60
