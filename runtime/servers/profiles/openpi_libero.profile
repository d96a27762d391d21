# openpi's LIBERO policies (pi0_libero, pi0_fast_libero, pi05_libero), with LiberoInputs' keys:
#   openpi://HOST:PORT?profile=openpi_libero
# For scenes of suite/libero: two cameras that mirror their pictures, a Panda, ten steps of waiting. The state counts in the world and
# has the hand's turn as robosuite's axis-angle (`libero`). Actions are LIBERO's own: -1 to 1, 5 cm and 0.5 rad a step, the gripper +1
# when closed. Five of an answer's actions are done.
protocol = openpi
about = pi0, pi0-FAST and pi0.5 on LIBERO behind openpi's server, pictures of two cameras
image = first -> observation/image 224x224 pad
image = wrist -> observation/wrist_image 224x224 pad
prompt.key = prompt
state.key = observation/state
state.layout = libero
arm.joints = 7
state.type = f64
action.form = delta
action.units = box
action.scale_m = 0.05
action.scale_rad = 0.5
action.rotation = vector
action.gripper = signed_inverted
chunk.use = 5
timeout.connect_s = 60
timeout.wait_s = 60
