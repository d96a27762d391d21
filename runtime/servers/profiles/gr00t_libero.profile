# GR00T N1.6 or later fine-tuned on LIBERO (embodiment LIBERO_PANDA), its server started with --use-sim-policy-wrapper:
#   gr00t://HOST:PORT?profile=gr00t_libero
# For scenes of suite/libero. `roll`, `pitch` and `yaw` of the state are robosuite's axis times an angle, as that of other policies of
# LIBERO (`libero`), and so is the turn of an action; both fingers are one entry. NVIDIA's evaluation does 8 actions of an answer
# (--n_action_steps 8); it begins where an environment's reset puts things, not from the benchmark's stored starts, and does not wait.
protocol = gr00t
about = GR00T N1.6 or later on LIBERO, pictures of two cameras, eight actions of each answer
dialect = n1.6                       # or n1.6_nested, without the wrapper
image = first -> video.image
image = wrist -> video.wrist_image
prompt.key = annotation.human.action.task_description
state.key = state
state.layout = libero
arm.joints = 7
action.form = delta
action.units = box
action.scale_m = 0.05
action.scale_rad = 0.5
action.rotation = vector
action.gripper = unit
action.threshold = 0.5
chunk.use = 8
timeout.connect_s = 60
timeout.wait_s = 60
