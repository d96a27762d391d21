// Pictures in the size and form that a server expects. Resizing is Pillow's bilinear filter to the
// bit (libImaging/Resample.c: a triangle as wide as the reduction, weights in 22-bit fixed point),
// because that is what the policies' own clients use.
#pragma once

#include "runtime/policy/policy.h"
#include "runtime/servers/profile.h"
#include "runtime/wire/value.h"

namespace probe::servers {

// The picture as the rule asks: u8 [h, w, 3] or f32 [3, h, w]. The image's bytes fit its size.
wire::Array to_pixels(const policy::Image& image, const ImageRule& rule);

// width x height x 3 bytes, both sides resampled.
wire::Bytes resize_bilinear(const policy::Image& image, int width, int height);

}  // namespace probe::servers
