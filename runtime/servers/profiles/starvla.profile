# What starvla:// does without profile=: starVLA's WebSocket server with a policy of BridgeData V2, asked
# at every step as its own evaluation in SimplerEnv asks, but without that client's ensemble of
# answers by their likeness: write ?ensemble=temporal for the mean of them.
# unnorm_key names the data set whose statistics the server uses; it lists those that it has.
protocol = starvla
about = a starVLA policy of BridgeData V2, one action of each answer
unnorm_key = oxe_bridge
image = first -> image 224x224 cv2_area
prompt.key = lang
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.threshold = 0.5
chunk.use = 1
timeout.connect_s = 60
timeout.wait_s = 60
