#include "runtime/base/cache_folder.h"

#include <cstdlib>

namespace probe {
namespace {

std::string text_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

}  // namespace

std::string cache_folder(const std::string& kind) {
  if (const char* chosen = std::getenv("VLAPROBE_CACHE"); chosen != nullptr)
    return *chosen == '\0' ? "" : std::string(chosen) + "/" + kind;
  const std::string xdg = text_of("XDG_CACHE_HOME");  // relative ones are to be ignored
  if (xdg.starts_with('/')) return xdg + "/vlaprobe/" + kind;
  const std::string home = text_of("HOME");
  return home.empty() ? "" : home + "/.cache/vlaprobe/" + kind;
}

}  // namespace probe
