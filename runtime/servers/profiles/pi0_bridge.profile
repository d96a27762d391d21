# pi0 fine-tuned on BridgeData V2, behind INT-ACT's server:
#   intact://HOST:PORT?profile=pi0_bridge&model=/path/to/checkpoint
# The server turns the pose into BridgeData's (roll pitch yaw from the tool pointing down),
# normalises it, and answers four actions that are already denormalised, rotation vectors with the
# gripper at -1 or +1.
protocol = intact
about = pi0 on BridgeData V2 behind INT-ACT's server, four actions an answer
image = first -> observation.images.top
prompt.key = task
state.key = observation.state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
chunk.use = 4
timeout.connect_s = 300
timeout.wait_s = 300
