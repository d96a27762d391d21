// What a results folder holds is known by its database: a run's episodes, or a model's answers;
// never both, since each has a plan of its own beside it. Header only.
#pragma once

#include <filesystem>
#include <string>

#include "runtime/base/paths.h"

namespace probe {

inline constexpr const char* kRunDatabase = "results.sqlite";
inline constexpr const char* kAnswersDatabase = "answers.sqlite";

inline std::string path_in(const std::string& dir, const char* database) {
  return (std::filesystem::path(dir) / database).string();
}
inline bool holds_run(const std::string& dir) { return is_there(path_in(dir, kRunDatabase)); }
inline bool holds_answers(const std::string& dir) {
  return is_there(path_in(dir, kAnswersDatabase));
}

}  // namespace probe
