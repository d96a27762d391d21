# SpatialVLA's Bridge checkpoint behind INT-ACT's server:
#   intact://HOST:PORT?profile=spatialvla_bridge&model=/path/to/checkpoint
# One action an answer: the server blends its chunks itself and forgets them at a reset, which
# reaches every connection. So give each world its own server, or run with --jobs 1.
protocol = intact
about = SpatialVLA on BridgeData V2 behind INT-ACT's server
image = first -> observation.images.top
prompt.key = task
state.key = observation.state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
chunk.length = 1
worlds = one
timeout.connect_s = 300
timeout.wait_s = 300
