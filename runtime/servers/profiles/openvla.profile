# What openvla:// does without profile=: OpenVLA's deploy.py with a model that has one data set's
# statistics.
protocol = openvla
about = OpenVLA's REST server, raw BridgeData actions
image = first -> image
prompt.key = instruction
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.threshold = 0.5
chunk.length = 1
timeout.connect_s = 60
timeout.wait_s = 60
