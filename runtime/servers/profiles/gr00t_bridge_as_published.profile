# GR00T N1.6 or later fine-tuned on BridgeData V2, its actions done as NVIDIA's published numbers were
# made: roll, pitch and yaw go unconverted to a controller that reads a rotation vector, and pictures
# are resized as cv2.resize does. For the same rotations as the data has, see gr00t_bridge_as_meant.
protocol = gr00t
about = GR00T on BridgeData V2 as published: roll pitch yaw read as a rotation vector
dialect = n1.6                       # or n1.6_nested, n1.5
image = first -> video.image_0 256x256 cv2_linear
prompt.key = annotation.human.action.task_description
state.key = state
state.layout = xyz_rpy_pad_openness
state.frame = top_down
action.form = delta
action.units = m_rad
action.rotation = vector
action.gripper = unit
action.threshold = 0.5
chunk.use = 1
timeout.connect_s = 15
timeout.wait_s = 60
