#include "runtime/base/large.h"

#include <atomic>

namespace probe {
namespace {

// Of the process: what it bounds is asked in places that know of no command line.
std::atomic<bool> is_allowed = false;

}  // namespace

void allow_large() { is_allowed = true; }

bool is_large_allowed() { return is_allowed; }

std::string large_hint() {
  if (is_allowed) return "";
  return "; `vlaprobe --allow-large` allows " + std::to_string(kLargeFactor) + " times as much";
}

}  // namespace probe
