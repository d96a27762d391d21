// What a policy server wants to be sent and how its answers are meant: a small text file of lines
// `field = value`, checked whole. Every client of a server follows one. Knows no wire format.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/sticky_gripper.h"

namespace probe::servers {

enum class Protocol {
#define PROBE_PROTOCOL(name, row) name,
#include "runtime/servers/protocols/protocols.def"
#undef PROBE_PROTOCOL
};
enum class Resize {
  kNone,
  kStretch,     // to the size, whatever the shape
  kPad,         // the whole picture, black bars around it: openpi's resize_with_pad
  kCrop,        // the middle of the picture in the size's shape, then resized
  kLanczos,     // to the size, by Pillow's LANCZOS: RoboArena's evaluator
  kCv2Linear,   // to the size, as cv2.resize does: GR00T's client
  kCv2Area,     // to the size, as cv2.resize with INTER_AREA does
  kTfLanczos3,  // to the size, as tf.image.resize with antialias does: Octo's data, OpenVLA's
                // clients
};
enum class PixelLayout {
  kHwcU8,   // [height, width, 3], 0..255
  kChwF32,  // [3, height, width], 0..1
};
// Numbers of the end effector in the robot's base frame, in this order. Quaternions are w x y z;
// rpy is R = Rz(yaw) Ry(pitch) Rx(roll), "sxyz"; openness is 0 closed .. 1 open; fingers are the
// last joints, m, as many as move fingers; joints are all driven ones in the plan's order. Counts
// below are for two finger joints.
enum class StateLayout {
  kNone,
  kXyzWxyzOpenness,    // 8
  kXyzRpyOpenness,     // 7
  kXyzRpyPadOpenness,  // 8, the pad is 0
  kXyzRotvecOpenness,  // 7
  kXyzXyzwClosedness,  // 8, as the data of RT-1 (fractal20220817_data)
  kXyzRotvecFingers,   // 8
  kJoints,
  kJointsOpenness,  // without the fingers
  kArmJoints,       // without the fingers
  kFingers,         // 2
  kOpenness,        // 1
  kClosedness,      // 1, 0 open .. 1 closed, as DROID counts
  kLibero,          // 8: libero_state.h
};
enum class StateFrame {
  kBase,
  kTopDown,  // rotations relative to the tool pointing down, as BridgeData's policies want them:
             // R * [[0,0,1],[0,1,0],[-1,0,0]]^T
};
enum class NumberType { kF32, kF64 };
// How numbers were made about 1 in size: bound maps [low, high] to [-1, 1], gaussian is
// (x - mean) / std.
enum class Normalisation { kNone, kBound, kGaussian };
// What of an action's meaning cannot be seen in its shape is kUnsaid until the profile, or the
// server, says it; `run` refuses what neither says and no answer shows.
enum class RotationForm { kUnsaid, kVector, kEuler };  // three numbers, rad; euler is rpy as above
enum class ActionForm {
  kUnsaid,
  kDelta,     // what the pose changes by in a control step
  kAbsolute,  // the pose to be at, in the base frame
  // Of the arm's joints in the plan's order, as many numbers as it has, before the gripper's.
  kJoints,      // the positions to be at, rad
  kJointSteps,  // what they change by in a control step
};
inline bool names_joints(ActionForm form) {
  return form == ActionForm::kJoints || form == ActionForm::kJointSteps;
}
enum class ActionUnits {
  kUnsaid,
  kMetric,  // m and rad
  kBox,     // each number within -1 .. 1, times action.scale_m and action.scale_rad: LIBERO, and
            // DROID's velocities of joints
  kBall,    // shift and turn of length 1 at most, times them: DROID's velocities
};
enum class GripperRange {
  kSigned,          // -1 closed .. +1 open, as the simulator's
  kUnit,            // 0 closed .. 1 open
  kSignedInverted,  // +1 closed
  kUnitInverted,    // 1 closed
  // How far it is to go, under `ee_delta_interpolated`: +1 all the way open, -1 closed, 0 not.
  kStep,
  kStepInverted,  // +1 closed
};
inline bool is_step(GripperRange range) {
  return range == GripperRange::kStep || range == GripperRange::kStepInverted;
}
inline bool is_inverted(GripperRange range) {
  return range == GripperRange::kSignedInverted || range == GripperRange::kUnitInverted ||
         range == GripperRange::kStepInverted;
}
enum class PromptCase { kAsIs, kLower };
enum class FullStop { kAsIs, kWithout, kWith };
enum class Ensemble { kNone, kTemporal };
enum class ConnectionUse {
  kKept,
  kPerEpisode,  // made anew for each episode, for servers that keep something and hear no reset
};

// What becomes of the checkpoint that an address names, at servers that are told one.
enum class CheckpointUse {
  kNamed,
  kIgnored,  // the server loads what its own configuration says
};

// How many worlds may ask a server at once.
enum class WorldsAtOnce {
  kMany,
  kOne,  // it keeps something of an episode for all its connections, or resets them all
};

struct ImageRule {
  std::string camera;  // empty: the scene's first
  std::string key;
  int width = 0, height = 0;  // 0: as rendered
  Resize resize = Resize::kNone;
  PixelLayout layout = PixelLayout::kHwcU8;
  bool is_jpeg = false;  // goes through JPEG before it is resized, see jpeg_round_trip.h
  bool operator==(const ImageRule&) const = default;
};

// A state beside the first, under a key of its own.
struct StateRule {
  std::string key;
  StateLayout layout = StateLayout::kNone;
  bool operator==(const StateRule&) const = default;
};

struct Statistics {
  Normalisation kind = Normalisation::kNone;
  std::vector<double> low, high;  // bound: usually the data's first and 99th percentile
  std::vector<double> mean, std;  // gaussian
  std::vector<double> mask;       // 1 where it applies, 0 elsewhere; empty: everywhere
  bool operator==(const Statistics&) const = default;
};

struct Profile {
  std::string name;  // of the file, without its ending; not a field
  Protocol protocol = Protocol::kOpenpi;
  std::string about;

  std::vector<ImageRule> images;

  std::string prompt_key = "prompt";
  PromptCase prompt_case = PromptCase::kAsIs;
  FullStop prompt_full_stop = FullStop::kAsIs;

  std::string state_key = "observation/state";
  StateLayout state_layout = StateLayout::kNone;
  StateFrame state_frame = StateFrame::kBase;
  NumberType state_type = NumberType::kF32;
  Statistics state_statistics;
  std::vector<StateRule> more_states;

  ActionForm action_form = ActionForm::kUnsaid;
  ActionUnits action_units = ActionUnits::kUnsaid;
  double action_scale_m = 1, action_scale_rad = 1;  // of kBox and kBall
  RotationForm action_rotation = RotationForm::kUnsaid;
  GripperRange action_gripper = GripperRange::kSigned;
  // Of the gripper's number as it came: above is open (closed, where inverted). None: kept, mapped
  // to -1 .. +1.
  std::optional<double> action_threshold;
  // Under `ee_delta_interpolated`: an opening becomes how far to go, one switch held for so many
  // steps.
  StickyRule action_sticky = StickyRule::kNone;
  int action_sticky_steps = 15;
  Statistics action_statistics;
  // A larger change in one control step is refused: something else than m and rad came.
  double action_limit_m = 1;
  double action_limit_rad = 6.3;

  int chunk_length = 0;  // actions of an answer; 0: any number
  int chunk_use = 0;     // how many of them are done before the next question; 0: all

  Ensemble ensemble = Ensemble::kNone;
  // Temporal: a question every step; an action is the mean of all answers' predictions of it, each
  // newer one weighing this many times the one before. SimplerEnv's temperature T is exp(-T).
  double ensemble_ratio = 1;

  // Of the arm that `policy test` asks about; a run asks about its plan's.
  int arm_joints = 6;

  ConnectionUse connection = ConnectionUse::kKept;
  CheckpointUse checkpoint = CheckpointUse::kNamed;
  WorldsAtOnce worlds = WorldsAtOnce::kMany;

  // Seconds.
  double wait_s = 30;       // for a server that is not there, trying again
  double connect_s = 10;    // one attempt
  double first_s = 300;     // the first answer of a connection: the server may still compile
  double answer_s = 60;     // any other
  int largest_answer = 64;  // MiB

  // Of single protocols; each says which it reads.
  std::string dialect;
  std::string unnorm_key;

  bool operator==(const Profile&) const = default;
};

// `where` names the text in messages. Fails (kUsage, where = "where:line:column") on an
// unknown field, with the nearest; on a value that is none, with those that are; on a field twice;
// on fields that do not go together.
Result<Profile> parse_profile(std::string_view text, std::string_view where);

// One field, as `text` would set it in a file. Fails without a place.
Status set_field(Profile& profile, std::string_view field, std::string_view value);
// What set_field cannot see: fields that do not go together.
Status check_profile(const Profile& profile);

// Every field that differs from an empty profile's, in the table's order, as a file that reads back
// equal. Equal profiles have equal texts.
std::string to_text(const Profile& profile);

// 64 hexadecimal digits over everything but `about` and the limits on time and size: profiles that
// do the same have the same.
std::string profile_sha256(const Profile& profile);

// A line for each field: its name, the values it takes, what it means.
std::string profile_help();

std::string_view to_word(Protocol protocol);
// In the order of protocols.def.
std::span<const Protocol> all_protocols();

}  // namespace probe::servers
