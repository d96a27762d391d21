// What of its actions' meaning a profile and a server leave open, and what answers show of it. A
// run does not begin on a guess: metres taken for shares of a step, or poses for changes, look like
// a bad policy.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/questions.h"

namespace probe::servers {

struct OpenField {
  std::string field;                // "action.form"
  std::vector<std::string> values;  // that it can have, in words of a profile
};

// Those that are kUnsaid, in the profile's order; `adapted` is a profile as the server wants it.
std::vector<OpenField> open_fields(const Profile& adapted);

// The value that the answers leave as the only one, or nothing. `answers` are to observations with
// known_state(false). Poses show themselves by being where the tool is; roll pitch yaw and rotation
// vectors where one of them could not be; what 1 stands for is in no answer.
std::optional<std::string> measured_value(const OpenField& open, const Profile& adapted,
                                          const std::vector<Chunk>& answers);

// Fails (kUsage) naming what is neither said nor in `measured` (fields of a profile with values),
// with the lines that would say it.
Status check_said(const Profile& adapted,
                  const std::vector<std::pair<std::string, std::string>>& measured,
                  const std::string& server);

}  // namespace probe::servers
