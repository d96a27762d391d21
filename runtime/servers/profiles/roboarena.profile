# What roboarena:// does without profile=. The server says which of these pictures it wants and how
# large. DROID's gripper is 1 when closed, its rotations are roll pitch yaw.
protocol = roboarena
about = RoboArena's server, changes of the end effector
image = first -> observation/exterior_image_0_left
prompt.key = prompt
action.rotation = euler
action.gripper = unit_inverted
action.threshold = 0.5
timeout.connect_s = 60
timeout.wait_s = 60
