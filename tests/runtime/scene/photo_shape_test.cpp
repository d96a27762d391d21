#include "runtime/scene/photo_shape.h"

#include <doctest/doctest.h>

namespace probe::scene {

TEST_CASE("a photo of another size is scaled, a pixel of rounding is fine, another shape is not") {
  CHECK_FALSE(photo_defect({640, 480}, 640, 480));
  CHECK_FALSE(photo_defect({1280, 960}, 640, 480));
  CHECK_FALSE(photo_defect({213, 160}, 640, 480));
  CHECK(photo_defect({320, 200}, 640, 480).value_or("").starts_with(
      "the photo is 320 x 200 pixels, the camera's picture 640 x 480: "));
  CHECK(photo_defect({480, 640}, 640, 480).has_value());
  // Of a speck one pixel is all of its shape.
  CHECK(photo_defect({1, 1}, 640, 512).has_value());
  CHECK(photo_defect({2, 1}, 640, 512).has_value());
  CHECK(photo_defect({2, 2}, 640, 480).has_value());
  CHECK_FALSE(photo_defect({5, 4}, 640, 512));
  CHECK_FALSE(photo_defect({27, 20}, 640, 480));
}

}  // namespace probe::scene
