// Pictures in the size and form that a server expects, as the policies' own clients make them, to
// the bit: Pillow's filters (libImaging/Resample.c: as wide as the reduction, weights in 22-bit
// fixed point) and OpenCV's; TensorFlow's nearly to it.
#pragma once

#include "runtime/policy/policy.h"
#include "runtime/servers/profile.h"
#include "runtime/wire/value.h"

namespace probe::servers {

// The picture as the rule asks: u8 [h, w, 3] or f32 [3, h, w]. The image's bytes fit its size.
wire::Array to_pixels(const policy::Image& image, const ImageRule& rule);

// What of a picture is sent, before it is resized: all of it, unless the rule crops.
struct SentPart {
  int left = 0, top = 0, width = 0, height = 0;
};
SentPart sent_part(int width, int height, const ImageRule& rule);

// width x height x 3 bytes, both sides resampled.
wire::Bytes resize_bilinear(const policy::Image& image, int width, int height);
wire::Bytes resize_lanczos(const policy::Image& image, int width, int height);

// cv2.resize of OpenCV 4: INTER_LINEAR looks at four pixels however much smaller the picture gets;
// INTER_AREA takes the mean of what an output pixel covers.
wire::Bytes resize_cv2_linear(const policy::Image& image, int width, int height);
wire::Bytes resize_cv2_area(const policy::Image& image, int width, int height);

// tf.image.resize with lanczos3 and antialias, to the nearest level of 0 .. 255: within one level
// of TensorFlow's, whose sums of floats are rounded as it was compiled.
wire::Bytes resize_tf_lanczos3(const policy::Image& image, int width, int height);

}  // namespace probe::servers
