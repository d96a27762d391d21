# openpi's DROID policies, with DroidInputs' keys:
#   openpi://HOST:PORT?profile=openpi_droid
# The scene needs a second camera called `wrist` and a robot of seven joints. Published checkpoints
# answer eight numbers, velocities of joints, which are refused: this is for policies trained to
# answer DROID's cartesian velocities under these keys.
protocol = openpi
about = DROID policies behind openpi's server, pictures of two cameras
image = first -> observation/exterior_image_1_left 224x224 pad
image = wrist -> observation/wrist_image_left 224x224 pad
prompt.key = prompt
state.key = observation/joint_position
state.layout = arm_joints
state.more = observation/gripper_position closedness
state.type = f64
action.form = delta
action.units = ball
action.scale_m = 0.075
action.scale_rad = 0.15
action.rotation = euler
action.gripper = unit_inverted
action.threshold = 0.5
timeout.connect_s = 60
timeout.wait_s = 60
