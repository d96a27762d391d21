// Arrays as the bytes of a .npy file (numpy.lib.format, version 1.0), which GR00T puts inside its
// messages.
#pragma once

#include <string>
#include <vector>

#include "runtime/wire/value.h"

namespace probe::wire {

Bytes to_npy(const Array& array);

// Fails (kPolicy) on another magic, a header that is no header, Fortran order, a dtype that
// is not read, or bytes that do not fit the shape.
Result<Array> from_npy(const Bytes& file);
// A row of texts of fixed width, "<U35". Fails as from_npy does, and on letters beyond ASCII.
Result<std::vector<std::string>> texts_from_npy(const Bytes& file);

}  // namespace probe::wire
