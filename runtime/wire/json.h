// Messages as JSON, with numpy arrays as the Python package json_numpy writes them:
// {"__numpy__": base64 of the bytes in C order, "dtype": "<f8", "shape": [7]}. The only file of
// this folder that includes nlohmann's JSON is json.cpp.
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/wire/value.h"

namespace probe::wire {

// Bytes are written as base64 text; numbers that are not finite as Python writes them.
std::string to_json(const Value& value);

// One whole document. Maps that mark an array become Array. Fails (kPolicy) on what is no
// JSON, on more than 64 levels, on a marked array whose bytes do not fit its shape.
Result<Value> from_json(std::string_view text);

}  // namespace probe::wire
