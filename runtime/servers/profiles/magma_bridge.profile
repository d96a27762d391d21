# Magma behind INT-ACT's server:
#   intact://HOST:PORT?profile=magma_bridge&model=/path/to/checkpoint
# One action an answer.
protocol = intact
about = Magma behind INT-ACT's server
image = first -> observation.images.top
prompt.key = task
state.key = observation.state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
chunk.length = 1
timeout.connect_s = 300
timeout.wait_s = 300
