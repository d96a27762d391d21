# OpenVLA fine-tuned on a suite of LIBERO, its picture as its own evaluation prepares it (through JPEG, then lanczos3 to 224 x 224):
#   openvla://HOST:PORT?profile=openvla_libero&unnorm_key=libero_spatial
# The statistics are the suite's (libero_spatial, libero_object, libero_goal, libero_10; `_no_noops` in some checkpoints). Answers are
# LIBERO's own -1 to 1; the gripper is 0 closed to 1 open, cut at 0.5. A checkpoint trained with random crops wants the middle nine tenths
# of the picture: the server's part.
protocol = openvla
about = OpenVLA on LIBERO, one picture as its own evaluation prepares it
image = first -> image 224x224 tf_lanczos3 jpeg95
prompt.key = instruction
prompt.case = lower
arm.joints = 7
action.form = delta
action.units = box
action.scale_m = 0.05
action.scale_rad = 0.5
action.rotation = vector
action.gripper = unit
action.threshold = 0.5
chunk.length = 1
timeout.connect_s = 60
timeout.wait_s = 60
