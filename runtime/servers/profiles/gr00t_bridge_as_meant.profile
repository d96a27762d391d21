# GR00T N1.6 or later fine-tuned on BridgeData V2, its actions done as they are meant: roll, pitch and
# yaw become the rotation that they are. NVIDIA's own evaluation does not, see
# gr00t_bridge_as_published. SimplerEnv does one action of an answer; write ?chunk.use=4 for more.
protocol = gr00t
about = GR00T on BridgeData V2 as meant: roll pitch yaw converted
dialect = n1.6                       # or n1.6_nested, n1.5
image = first -> video.image_0 256x256 cv2_linear
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
