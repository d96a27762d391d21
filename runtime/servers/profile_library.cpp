#include "runtime/servers/profile_library.h"

#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/base/spelling.h"

namespace probe::servers {

Result<Profile> find_profile(std::string_view name) {
  if (names_file(name)) {
    const std::filesystem::path path(name);
    auto text = read_file(path.string());
    if (!text) return Failure{Fault::kUsage, text.failure().message, path.string()};
    PROBE_ASSIGN(Profile profile, parse_profile(*text, path.string()));
    profile.name = path.stem().string();
    return profile;
  }
  std::vector<std::string> names;
  std::string list;
  for (const ProfileText& ready : ready_profiles()) {
    if (ready.name == name) {
      PROBE_ASSIGN(Profile profile, parse_profile(ready.text, std::string(name) + ".profile"));
      profile.name = name;
      return profile;
    }
    names.emplace_back(ready.name);
    list += (list.empty() ? "" : ", ") + std::string(ready.name);
  }
  return Failure{Fault::kUsage,
                 "there is no profile `" + std::string(name) + "`" + did_you_mean(name, names) +
                     "; ready ones are " + list + "; a path, as in ./mine.profile, names a file",
                 "--policy"};
}

}  // namespace probe::servers
