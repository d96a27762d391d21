// The axes along which two tasks of one plan differ, by name and from the records alone: what the
// compiler declares of a variant can be checked against it. Knows nothing of phrases and frames,
// which a plan does not carry.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plan/axes.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// Everything but language as a mask; of language only whether it moved: the instructions differ
// also when the names of source and target are taken out of both.
struct Difference {
  std::uint32_t axes = 0;
  bool language = false;
};
Difference difference(const plan::Plan& plan, std::uint32_t a, std::uint32_t b);

// The same by name. Between a variant and its baseline they are those that the compiler stored,
// between any other two tasks there is one word for all of language, "language".
std::vector<std::string> axes_between(const plan::Plan& plan, std::uint32_t a, std::uint32_t b);

}  // namespace probe::inspect
