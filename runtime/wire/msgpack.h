// Messages as MessagePack, with numpy arrays in the three ways that policy servers write them. The
// only file that includes msgpack-cxx is msgpack.cpp.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/base/result.h"
#include "runtime/wire/value.h"

namespace probe::wire {

// How an array is written; all are read.
enum class ArrayStyle {
  kBinKeys,   // openpi: {b"__ndarray__": true, b"data", b"dtype", b"shape"}, keys as bin because
              // Python's are bytes
  kTextKeys,  // vla-eval: the same with text keys
  kNpy,       // GR00T: {"__ndarray_class__": true, "as_npy": a .npy file}
};

Bytes to_msgpack(const Value& value, ArrayStyle style);

// One whole message. Maps that mark an array or a numpy scalar become Array and number; keys are
// text or bin. Fails (kPolicy) on trailing or missing bytes, on more than 64 levels, on a
// marked array whose bytes do not fit its shape, on keys that are no texts. Memory is bounded by
// the message's own size.
Result<Value> from_msgpack(std::span<const std::uint8_t> bytes);

}  // namespace probe::wire
