# openvla/openvla-7b, whose statistics for BridgeData V2 are called bridge_orig:
#   openvla://HOST:PORT?profile=openvla_bridge
# Pictures go as rendered (openvla_bridge_as_evaluated prepares them as OpenVLA's own evaluation).
# The server resizes pictures, lowers the instruction's case and un-normalises its actions itself.
protocol = openvla
about = OpenVLA 7B on BridgeData V2 behind its REST server
unnorm_key = bridge_orig
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
