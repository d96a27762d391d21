# A LeRobot policy (smolvla, pi0, act ...) trained on BridgeData V2 with the features that GR00T's and
# others' conversions of it have: image_0, and a state of eight with roll pitch yaw and a pad.
#   lerobot://HOST:PORT?type=smolvla&model=PATH&profile=lerobot_bridge
# Where yours has other features, copy this file and change them.
protocol = lerobot
about = a LeRobot policy of BridgeData V2, raw BridgeData actions
image = first -> observation.images.image_0 256x256 cv2_area
prompt.key = task
state.key = observation.state
state.layout = xyz_rpy_pad_openness
state.frame = top_down
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.threshold = 0.5
chunk.use = 4
timeout.connect_s = 60
timeout.wait_s = 60
