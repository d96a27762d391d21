// Whether the numbers of an action can be meant, whatever the law.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::robot {

// What number i of an action of `size` is to be, for messages: "a shift in metres".
using SaysWanted = std::string_view (*)(std::size_t i, std::size_t size);

// Fails (kPolicy) on a number that is not finite or beyond kAbsurdAction in size, by its place and
// by what was wanted there.
Status check_numbers(std::span<const double> action, SaysWanted wanted);

// Of a ToolAction.
Status check_tool_action(std::span<const double> action);

}  // namespace probe::robot
