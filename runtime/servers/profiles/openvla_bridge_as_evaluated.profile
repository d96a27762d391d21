# openvla/openvla-7b with pictures as OpenVLA's own evaluation on BridgeData prepares them
# (experiments/robot/bridge/bridgev2_utils.py, resize_image): as the training data, through JPEG, then
# lanczos3 to 224 x 224 with antialias. OpenVLA-OFT's clients do the same.
#   openvla://HOST:PORT?profile=openvla_bridge_as_evaluated
protocol = openvla
about = OpenVLA 7B on BridgeData V2, pictures as its own evaluation prepares them
unnorm_key = bridge_orig
image = first -> image 224x224 tf_lanczos3 jpeg95
prompt.key = instruction
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.threshold = 0.5
chunk.length = 1
timeout.connect_s = 60
timeout.wait_s = 60
