# OpenVLA-OFT on LIBERO behind its own deploy.py (vla-scripts/deploy.py): two pictures, the state of eight, eight actions an answer,
# all of them done.
#   openvla://HOST:PORT?profile=openvla_oft_libero&unnorm_key=libero_spatial_no_noops
protocol = openvla
about = OpenVLA-OFT on LIBERO, two pictures and the state, eight actions an answer
image = first -> full_image 224x224 tf_lanczos3 jpeg95
image = wrist -> wrist_image 224x224 tf_lanczos3 jpeg95
prompt.key = instruction
prompt.case = lower
state.key = state
state.layout = libero
arm.joints = 7
state.type = f64
action.form = delta
action.units = box
action.scale_m = 0.05
action.scale_rad = 0.5
action.rotation = vector
action.gripper = unit
action.threshold = 0.5
chunk.length = 8
chunk.use = 8
timeout.connect_s = 60
timeout.wait_s = 60
