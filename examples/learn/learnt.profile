# What serve.py wants and means: the picture and the state as they were exported, and four actions an answer.
protocol = openpi
about = the policy of examples/learn behind examples/serve_simpler.py
image = first -> observation/image 128x96 stretch
prompt.key = prompt
state.key = observation/state
state.layout = xyz_rpy_openness
action.form = delta
action.units = m_rad
action.rotation = vector
action.threshold = 0
chunk.length = 4
chunk.use = 2
