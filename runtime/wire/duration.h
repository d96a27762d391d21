// Times of a wire and how messages say them.
#pragma once

#include <chrono>
#include <string>

namespace probe::wire {

using Duration = std::chrono::milliseconds;

// "0.5 s", "30 s".
inline std::string seconds_text(Duration time) {
  std::string text = std::to_string(static_cast<double>(time.count()) / 1000);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text + " s";
}

}  // namespace probe::wire
