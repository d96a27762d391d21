// RLDS as TensorFlow Datasets keeps it on disk: record files, an episode a record, in the step
// schema of BridgeData V2; pictures as PNG, lossless.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/result.h"
#include "runtime/export/dataset/dataset.h"
#include "runtime/export/dataset/layout.h"

namespace probe::dataset::rlds {

inline constexpr const char* kName = "vlaprobe_demos";
inline constexpr const char* kDatasetVersion = "1.0.0";

// Writes into `dir`/1.0.0; `dir` is there and empty. Fails with kIo.
Result<std::unique_ptr<Layout>> open_layout(const std::string& dir, const Shape& shape,
                                            const DatasetOptions& options);

}  // namespace probe::dataset::rlds
