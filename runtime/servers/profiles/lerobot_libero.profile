# A LeRobot policy of LIBERO (smolvla, pi0, pi05 ...) with the features of LeRobot's LIBERO data sets: image, image2 (the wrist), the
# state of eight.
#   lerobot://HOST:PORT?type=smolvla&model=PATH&profile=lerobot_libero
# LeRobot's own evaluation does all actions of an answer that its policy says (n_action_steps), SmolVLA's one; ?chunk.use=N says otherwise.
protocol = lerobot
about = a LeRobot policy of LIBERO (SmolVLA, pi0), two pictures and the state
image = first -> observation.images.image
image = wrist -> observation.images.image2
prompt.key = task
state.key = observation.state
state.layout = libero
arm.joints = 7
action.form = delta
action.units = box
action.scale_m = 0.05
action.scale_rad = 0.5
action.rotation = vector
action.gripper = signed_inverted
chunk.use = 1
timeout.connect_s = 60
timeout.wait_s = 60
