# pi0 fine-tuned on BridgeData V2, behind openpi's own server:
#   openpi://HOST:PORT?profile=pi0_bridge_openpi
# openpi ships no config for Bridge: this fits an input transform with libero's key names and
# BridgeData's numbers. Where yours has other names, copy this file and change the keys.
protocol = openpi
about = pi0 on BridgeData V2 behind openpi's server, raw BridgeData actions
image = first -> observation/image 224x224 pad
prompt.key = prompt
state.key = observation/state
state.layout = xyz_rpy_pad_openness
state.frame = top_down
action.form = delta
action.units = m_rad
action.rotation = euler
action.gripper = unit
action.threshold = 0.5
chunk.use = 4
timeout.connect_s = 60
timeout.wait_s = 60
