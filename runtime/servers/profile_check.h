// Mistakes of a profile that no single line shows: fields that do not go together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/servers/profile.h"

namespace probe::servers {

struct Mistake {
  std::string message;
  // Those at fault, as set_field names them; "image 2" is the second image.
  std::vector<std::string> fields;
};

// The first one that there is.
std::optional<Mistake> find_mistake(const Profile& profile);

// Two things that a request would carry under one key, of which one would never arrive; or one that
// has a key of the protocol's own.
std::optional<Mistake> find_key_conflict(const Profile& profile);

}  // namespace probe::servers
