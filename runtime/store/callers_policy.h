// How the content of a policy of the caller's begins: a function behind the C interface. What the
// caller says of it, such as the hash of its weights, follows behind ": ".
#pragma once

#include <string_view>

namespace probe::store {

inline constexpr std::string_view kCallersPolicy = "the caller's";

}  // namespace probe::store
