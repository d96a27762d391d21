# What vlaeval:// does without profile=: what SimplerEnv's benchmark sends there. The state is sent
# where the server asks for it, or with ?send_state=true. Chunks and ensembles are the server's. What
# its actions are, changes or poses, it says in its hello.
protocol = vlaeval
about = a vla-eval server, the gripper open above 0.5
image = first -> primary
prompt.key = task_description
state.key = states
state.layout = xyz_wxyz_openness
action.gripper = unit
action.threshold = 0.5
chunk.length = 1
timeout.connect_s = 60
timeout.wait_s = 60
