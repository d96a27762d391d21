// Arrays inside pickles: numpy's and PyTorch's, read and written. PyTorch's storages are pickles in
// a pickle (torch/serialization.py, the format before zip files).
#pragma once

#include <string_view>
#include <vector>

#include "runtime/wire/pickle.h"

namespace probe::wire {

// The globals that arrays are made of, to which a caller adds its own.
std::span<const std::string_view> array_globals();

// Of a numpy array or number, or a PyTorch tensor on the CPU: a copy in C order. Half floats and
// bfloat16 become 32-bit ones. Fails (kPolicy) on anything else, on big-endian numbers, on bytes
// that do not fit the shape, on more than `most_bytes`.
Result<Array> read_array(const Pickle& pickle, const PickleNode& node, std::size_t most_bytes);

void write_numpy(const Array& array, PickleWriter& writer);
// Of "<f4" or "<f8".
void write_torch(const Array& array, PickleWriter& writer);

}  // namespace probe::wire
