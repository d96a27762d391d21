// A picture as it comes out of a JPEG file: what training data went through, and so what clients of
// policies that were trained on it send theirs through.
#pragma once

#include "runtime/policy/policy.h"
#include "runtime/wire/value.h"

namespace probe::servers {

// tf.io.decode_image(tf.image.encode_jpeg(image)) by their defaults, to the bit: quality 95,
// colours at half the resolution, libjpeg-turbo's accurate integer transform there and its fast one
// back, colours interpolated. width * height * 3 bytes.
wire::Bytes through_jpeg(const policy::Image& image);

}  // namespace probe::servers
