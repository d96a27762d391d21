# What gr00t:// does without profile=: GR00T N1.6 and later on BridgeData V2 behind its simulation
# wrapper. How its roll, pitch and yaw are done is left open: NVIDIA's own evaluation hands them
# unconverted to a controller that reads rotation vectors, and published numbers were made so. Take
# gr00t_bridge_as_published or gr00t_bridge_as_meant, or say action.rotation.
protocol = gr00t
about = GR00T N1.6 or later on BridgeData V2, one action of each answer
dialect = n1.6                       # or n1.6_nested, n1.5
image = first -> video.image_0 256x256 cv2_linear
prompt.key = annotation.human.action.task_description
state.key = state
state.layout = xyz_rpy_pad_openness
state.frame = top_down
action.form = delta
action.units = m_rad
action.gripper = unit
action.threshold = 0.5
chunk.use = 1
timeout.connect_s = 15
timeout.wait_s = 60
