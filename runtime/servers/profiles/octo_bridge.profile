# Octo behind INT-ACT's server:
#   intact://HOST:PORT?profile=octo_bridge&model=hf://rail-berkeley/octo-small
# One action an answer. The server loads the model that its own configuration names, whatever it is
# told: a sweep needs a server for each checkpoint. It keeps the last pictures of the episode and its chunks, and
# forgets them at a reset, which reaches every connection. So give each world its own server, or
# run with --jobs 1.
protocol = intact
about = Octo behind INT-ACT's server
image = first -> observation.images.top
prompt.key = task
state.key = observation.state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
chunk.length = 1
checkpoint = ignored
worlds = one
timeout.connect_s = 300
timeout.wait_s = 300
