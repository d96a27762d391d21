// Time as seconds.
#pragma once

#include <chrono>

namespace probe {

// By the clock that never goes back.
inline double seconds_since(std::chrono::steady_clock::time_point from) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

// Since 1970, by the wall's clock.
inline double unix_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace probe
