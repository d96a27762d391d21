# A profile to copy: every field, with what it is when it is absent. Save it under another name and
# give its path: openpi://HOST:PORT?profile=./mine.profile
# `vlaprobe policy test openpi://HOST:PORT?profile=./mine.profile` says what does not fit.

protocol = openpi                    # openpi, intact, roboarena, vlaeval, gr00t, openvla, starvla
about = what it is, for people

# CAMERA -> KEY [WIDTHxHEIGHT stretch|pad|crop|lanczos|cv2_linear|cv2_area|tf_lanczos3] [jpeg95] [hwc_u8|chw_f32]. CAMERA is
# `first` or a camera's name in the scene. One line a picture. Without a size the picture is sent as rendered; with jpeg95
# it goes through a JPEG of quality 95 before, as TensorFlow writes and reads one.
image = first -> observation/image 224x224 pad

prompt.key = prompt
prompt.case = as_is                  # or lower
prompt.full_stop = as_is             # or with, without

state.key = observation/state
state.layout = xyz_rpy_pad_openness  # or none: no state is sent
state.frame = top_down               # or base; BridgeData's policies count from the tool pointing down
state.type = f32                     # or f64
state.normalise = none               # bound with state.low and state.high, gaussian with state.mean
                                     # and state.std: only where the server does not do it

# state.more = observation/gripper_position closedness    # another state, under its own key

action.form = delta                  # absolute: the pose to be at, in the base frame
action.units = m_rad                 # box: -1..1 each, ball: of length 1 at most, times these two:
# action.scale_m = 0.05
# action.scale_rad = 0.5
action.rotation = euler              # or vector
action.gripper = unit                # 0 closed .. 1 open; signed: -1 closed .. +1 open; step: how far to go; ..._inverted
action.threshold = 0.5               # above it the gripper opens; none: it goes part of the way
action.normalised = none             # bound or gaussian: only where the server answers raw numbers
# action.low  = -0.03 -0.04 -0.04 -0.08 -0.09 -0.2 0    # yours: the data's first percentile
# action.high =  0.03  0.04  0.04  0.08  0.09  0.2 1    # yours: its 99th
# action.mask =  1 1 1 1 1 1 0                          # the gripper is not normalised
action.limit_m = 1
action.limit_rad = 6.3

chunk.length = any                   # a number: another number of actions is refused
chunk.use = 4                        # of an answer, before the next question; or all
ensemble = none                      # temporal: a question every step (then without chunk.use)
ensemble.ratio = 1
connection = kept                    # per_episode: for servers that keep something and hear no reset
worlds = many                        # one: the server keeps something for all who ask it: --jobs 1
checkpoint = named                   # ignored: an INT-ACT server that loads what it is configured to

timeout.wait_s = 60                  # a server that is not there
timeout.connect_s = 60               # one attempt to connect
timeout.first_s = 300                # a connection's first answer
timeout.answer_s = 60                # any other
answer.largest_mib = 64
