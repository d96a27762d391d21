# GR00T N1.5 fine-tuned on LIBERO (examples/Libero, data config LiberoDataConfig):
#   gr00t://HOST:PORT?profile=gr00t_n15_libero
# As gr00t_libero, without a time dimension, the state in 64 bits, one action of each answer.
protocol = gr00t
about = GR00T N1.5 on LIBERO, pictures of two cameras, one action of each answer
dialect = n1.5
image = first -> video.image
image = wrist -> video.wrist_image
prompt.key = annotation.human.action.task_description
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
chunk.use = 1
timeout.connect_s = 60
timeout.wait_s = 60
