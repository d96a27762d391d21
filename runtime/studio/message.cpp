#include "runtime/studio/message.h"

namespace probe::studio {

wire::Frame message(const Json& json) { return wire::text_frame(json.dump()); }

wire::Frame picture_message(Json json, std::span<const stage::CameraFrame> frames) {
  Json cameras = Json::array();
  std::size_t pixels = 0;
  for (const stage::CameraFrame& seen : frames) {
    cameras.push_back(
        {{"name", seen.camera}, {"width", seen.frame.width}, {"height", seen.frame.height}});
    pixels += seen.frame.rgb.size() / 3;
  }
  json["cameras"] = std::move(cameras);
  const std::string head = json.dump();
  wire::Bytes bytes(4 + head.size() + 4 * pixels, 255);
  for (std::size_t i = 0; i < 4; ++i)
    bytes[i] = static_cast<std::uint8_t>(head.size() >> (8 * i) & 255);
  std::copy(head.begin(), head.end(), bytes.begin() + 4);
  std::uint8_t* to = bytes.data() + 4 + head.size();
  for (const stage::CameraFrame& seen : frames) {
    const std::uint8_t* from = seen.frame.rgb.data();
    for (std::size_t i = 0; i < seen.frame.rgb.size() / 3; ++i, from += 3, to += 4) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
    }
  }
  return {false, std::move(bytes)};
}

}  // namespace probe::studio
