#include "runtime/api/folders.h"

#include <algorithm>
#include <new>

#include "runtime/api/calls.h"

namespace probe::api {

static_assert(static_cast<int>(run::IfChanged::kFork) == VLAPROBE_FORK);

std::string text_of(const char* text) { return text == nullptr ? std::string() : text; }

AssetRoot folders_of(const char* text) {
  std::vector<std::string> folders;
  const std::string lines = text_of(text);
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    folders.push_back(lines.substr(begin, end - begin));
    begin = end + 1;
  }
  return AssetRoot::chosen(folders);
}

Status give_text(std::string_view text, char** out) {
  if (out == nullptr) return {};
  *out = copy_text(text);
  if (*out == nullptr) throw std::bad_alloc();
  return {};
}

Status give(const Json& json, char** out) { return give_text(json.dump(), out); }

Result<std::pair<int, int>> read_episodes(std::int32_t first, std::int32_t last) {
  if (first < 0 || last < first) {
    return usage("episodes go from a number to one that is no smaller, found " +
                 std::to_string(first) + " to " + std::to_string(last));
  }
  return std::pair(first, last);
}

Result<int> read_jobs(std::int32_t jobs, std::string_view what) {
  constexpr std::int32_t kMost = 1024;
  if (jobs < 0 || jobs > kMost) {
    return usage("there are 1 to 1024 " + std::string(what) + " at a time, found " +
                 std::to_string(jobs));
  }
  return std::max(jobs, 1);
}

Result<run::IfChanged> read_if_changed(std::int32_t if_changed) {
  if (if_changed < VLAPROBE_REFUSE || if_changed > VLAPROBE_CONTINUE)
    return usage("there is no `if_changed` " + std::to_string(if_changed));
  return static_cast<run::IfChanged>(if_changed);
}

}  // namespace probe::api
