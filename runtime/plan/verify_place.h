// Where a rule was broken: turns the address of a field inside a plan into section and byte. Of the
// verifier only.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "runtime/base/result.h"
#include "runtime/plan/rules.h"

namespace probe::plan {

class Place {
 public:
  explicit Place(std::span<const std::byte> bytes) : bytes_(bytes) {}

  // `at` points into the bytes; `where` of the failure is "TASK at byte 4096".
  Failure fail(Rule rule, const void* at, std::string message) const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace probe::plan
