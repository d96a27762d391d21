# What intact:// does without profile=. The server's env adapter makes what its policy wants of the
# raw pose and answers actions in the simulator's convention (rotation vector, gripper -1 or +1).
protocol = intact
about = INT-ACT's server with any of its Bridge policies
image = first -> observation.images.top
prompt.key = task
state.key = observation.state
state.layout = xyz_wxyz_openness
# A server that loads a model answers nobody.
timeout.connect_s = 300
timeout.wait_s = 300
