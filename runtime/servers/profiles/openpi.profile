# What openpi:// does without profile=: the whole picture, the end effector's pose, and actions in
# the simulator's own convention. openpi's servers resize pictures themselves.
protocol = openpi
about = openpi's server, actions as the simulator takes them
image = first -> observation/image
prompt.key = prompt
state.key = observation/state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
timeout.connect_s = 60
timeout.wait_s = 60
