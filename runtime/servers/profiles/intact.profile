# What intact:// does without profile=. The server's env adapter makes what its policy wants of the
# raw pose and answers actions in the simulator's convention (rotation vector, gripper -1 or +1).
protocol = intact
about = INT-ACT's server with any of its Bridge policies
image = first -> observation.images.top
prompt.key = task
state.key = observation.state
state.layout = xyz_wxyz_openness
action.form = delta
action.units = m_rad
action.rotation = vector
# Some of its policies keep pictures and instructions for all who ask: say worlds = many of one that
# does not, as pi0_bridge does.
# A server that loads a model answers nobody.
worlds = one
timeout.connect_s = 300
timeout.wait_s = 300
