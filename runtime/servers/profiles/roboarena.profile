# What roboarena:// does without profile=. The server says which of these pictures it wants, how
# large, and what its actions are: its action_space cartesian_velocity is lengths of at most 1 that
# stand for 0.075 m and 0.15 rad a step, cartesian_position is poses; joint_velocity is shares of
# 0.2 rad a step, joint_position where the joints are to be. DROID's gripper is 1 when closed, its
# rotations are roll pitch yaw.
protocol = roboarena
about = RoboArena's server: changes of the end effector, poses, or joints
image = first -> observation/exterior_image_1_left
prompt.key = prompt
state.type = f64
action.rotation = euler
action.gripper = unit_inverted
action.threshold = 0.5
timeout.connect_s = 60
timeout.wait_s = 60
