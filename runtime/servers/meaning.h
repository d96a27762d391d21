// What of its actions' meaning a profile and a server leave open, and what answers show of it. A
// run does not begin on a guess: metres taken for shares of a step, or poses for changes, look like
// a bad policy.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/known_observations.h"

namespace probe::servers {

struct OpenField {
  std::string field;                // "action.form"
  std::vector<std::string> values;  // that it can have, in words of a profile
};

// Those that are kUnsaid, in the profile's order, with the values that the protocol's servers can
// mean; `adapted` is a profile as the server wants it.
std::vector<OpenField> open_fields(const Profile& adapted);

// Answers to known observations, those with known_state(false) and those with known_state(true).
struct KnownAnswers {
  std::vector<Chunk> here, mirrored;
  KnownArm arm = {};
};

// Whether a mirrored question would show more of what is open: where answers may be joints, which
// are mirrored otherwise than poses are.
bool wants_mirrored(const Profile& adapted);

// The open fields, each with the values that the answers leave: one where they show it, all where
// they show nothing. Poses show themselves by being where the tool is, joints by being where the
// arm's are, on both sides; a small number may be a change of the pose or a step of a joint, which
// nothing tells apart where servers of the protocol answer either. Roll pitch yaw and rotation
// vectors show themselves where one of them could not be; what 1 stands for is in no answer. Fields
// that a measured form has no use for are left out.
std::vector<OpenField> left_open(const Profile& adapted, const KnownAnswers& answers);

// Those of `left` with one value: lines of a profile.
std::vector<std::pair<std::string, std::string>> measured_of(const std::vector<OpenField>& left);

// Fails (kUsage) naming what of `left` has more than one value, with the lines that would say it.
Status check_said(const Profile& adapted, const std::vector<OpenField>& left,
                  const std::string& server);

// Fails (kUsage) on a form that the robot's control law cannot carry out: poses and joints move the
// target that `ee_delta_pose` keeps; `osc_pose`, which keeps none, takes changes alone; a law of
// joints takes their numbers alone. kUnsaid passes. So does it on a gripper's number that is an
// opening where the law wants a step, and the other way round.
Status check_form(const Profile& profile, ActionForm form, robot::ControlKind control,
                  const std::string& server);

}  // namespace probe::servers
