# pi0 on the Google robot (RT-1's data) behind LeRobot's asynchronous server, for scenes of suite/google:
#   lerobot://HOST:PORT?type=pi0&model=PATH&profile=pi0_fractal_lerobot
# Picture, state, chunks and gripper as in pi0_fractal (SimplerEnv's simpler_env/policies/lerobotpi).
protocol = lerobot
about = pi0 on the Google robot behind LeRobot's server, raw actions of RT-1's data
image = first -> observation.images.image 224x224 cv2_area
prompt.key = task
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
