// robomimic's HDF5: one file, a group a demonstration, pictures as they are.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/result.h"
#include "runtime/export/dataset/layout.h"

namespace probe::dataset::robomimic {

inline constexpr const char* kFile = "demos.hdf5";

// Writes into `dir`, which is there and empty. Fails with kIo.
Result<std::unique_ptr<Layout>> open_layout(const std::string& dir, const Shape& shape);

}  // namespace probe::dataset::robomimic
