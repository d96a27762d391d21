// A step's pictures in the cameras and the sizes of a dataset.
#pragma once

#include <functional>
#include <span>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/export/dataset/demonstration.h"
#include "runtime/stage/stage.h"

namespace probe::dataset {

// Calls `use` with a picture for each camera of the shape, resized as Pillow's BILINEAR does where
// the policy saw another size; valid until it returns. Fails (kInternal) naming a camera that
// `frames` lack, and as `use` does.
Status in_shape(const Shape& shape, std::span<const stage::CameraFrame> frames,
                const std::function<Status(std::span<const Picture> pictures)>& use);

// run::picture_hash of a step's pictures, the bytes of one camera after the other.
Sha256 hash_of(std::span<const std::span<const std::uint8_t>> rgb);

}  // namespace probe::dataset
