// A benchmark that cannot be set up ends the program with the reason.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "runtime/base/result.h"

namespace probe::bench {

inline void need(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "bench: %s\n", to_text(status.failure()).c_str());
  std::exit(2);
}

template <typename T>
T need(Result<T> result) {
  if (!result.ok()) need(Status(result.failure()));
  return std::move(result).value();
}

inline std::string suite_path() { return VLAPROBE_SOURCE_DIR "/suite/intact.probe"; }
inline std::string asset_root() { return VLAPROBE_SOURCE_DIR "/assets"; }

}  // namespace probe::bench
