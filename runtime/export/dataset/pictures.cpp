#include "runtime/export/dataset/pictures.h"

#include <algorithm>
#include <vector>

#include "runtime/run/episode.h"
#include "runtime/servers/resize.h"

namespace probe::dataset {

Status in_shape(const Shape& shape, std::span<const stage::CameraFrame> frames,
                const std::function<Status(std::span<const Picture> pictures)>& use) {
  std::vector<wire::Bytes> resized(shape.cameras.size());
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < shape.cameras.size(); ++i) {
    const CameraShape& camera = shape.cameras[i];
    const auto seen = std::ranges::find_if(
        frames, [&](const stage::CameraFrame& frame) { return camera.is(frame.camera); });
    if (seen == frames.end())
      return Failure{Fault::kInternal, "a camera is not there any more", camera.name};
    const render::FrameView& frame = seen->frame;
    std::span<const std::uint8_t> rgb = frame.rgb;
    if (frame.width != camera.width || frame.height != camera.height) {
      resized[i] = servers::resize_bilinear({frame.width, frame.height, frame.rgb}, camera.width,
                                            camera.height);
      rgb = resized[i];
    }
    pictures.push_back({&camera, rgb});
  }
  return use(pictures);
}

Sha256 hash_of(std::span<const std::span<const std::uint8_t>> rgb) {
  std::vector<stage::CameraFrame> frames(rgb.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) frames[i].frame.rgb = rgb[i];
  return run::picture_hash(frames);
}

}  // namespace probe::dataset
