# GR00T N1.5 fine-tuned on BridgeData V2:
#   gr00t://HOST:PORT?profile=gr00t_n15_bridge
# Its requests have no time dimension, and it hears no reset.
protocol = gr00t
about = GR00T N1.5 on BridgeData V2, one action of each answer
dialect = n1.5
image = first -> video.image_0 256x256 stretch
prompt.key = annotation.human.action.task_description
state.key = state
state.layout = xyz_rpy_pad_openness
state.frame = top_down
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.threshold = 0.5
chunk.use = 1
timeout.connect_s = 15
timeout.wait_s = 60
