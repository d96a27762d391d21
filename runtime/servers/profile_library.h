// Profiles by name: those of runtime/servers/profiles are part of the program; a path names a file.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/servers/profile.h"

namespace probe::servers {

struct ProfileText {
  std::string_view name;
  std::string_view text;
};

// Ascending by name.
std::span<const ProfileText> ready_profiles();

// Whether `name` is the path of a file: it has a `/` or ends in `.profile`.
inline bool names_file(std::string_view name) {
  return name.find('/') != std::string_view::npos || name.ends_with(".profile");
}

// `name` of a ready profile, or the path of a file. Fails
// (kUsage) with the names there are and the nearest, and as parse_profile does.
Result<Profile> find_profile(std::string_view name);

}  // namespace probe::servers
