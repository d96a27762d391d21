// allenai/vla-evaluation-harness: src/vla_eval/protocol, benchmarks/simpler/benchmark.py.
#include "runtime/servers/protocols/vlaeval_messages.h"

#include "runtime/scene/image.h"
#include "runtime/wire/msgpack.h"

namespace probe::servers::vlaeval {
namespace {

// Above 90 the colours keep their resolution.
constexpr int kJpegQuality = 95;

// A picture in the protocol's own form, or as the plain array that its servers read as well.
Result<wire::Value> coded(const wire::Array& pixels, PictureCoding coding) {
  const bool is_picture = pixels.dtype == "|u1" && pixels.shape.size() == 3 && pixels.shape[2] == 3;
  if (coding == PictureCoding::kRaw || !is_picture) return wire::Value(pixels);
  const int height = static_cast<int>(pixels.shape[0]), width = static_cast<int>(pixels.shape[1]);
  const bool is_png = coding == PictureCoding::kPng;
  PROBE_ASSIGN(const std::string data,
               is_png ? scene::png_bytes(width, height, pixels.bytes)
                      : scene::jpeg_bytes(width, height, pixels.bytes, kJpegQuality));
  wire::List shape;
  for (const std::int64_t n : pixels.shape) shape.emplace_back(n);
  return wire::Value(wire::Map{{"__image__", true},
                               {"format", is_png ? "png" : "jpeg"},
                               {"data", wire::Bytes(data.begin(), data.end())},
                               {"shape", std::move(shape)}});
}

wire::Array pose_array(const Pose& pose) {
  const Vec3& at = pose.position;
  const Quat& q = pose.rotation;
  return wire::array_f32({7}, {at.x(), at.y(), at.z(), q.w(), q.x(), q.y(), q.z()});
}

}  // namespace

wire::Bytes to_bytes(const Message& message, double timestamp) {
  return wire::to_msgpack(wire::Map{{"type", message.type},
                                    {"payload", message.payload},
                                    {"seq", message.seq},
                                    {"timestamp", timestamp}},
                          wire::ArrayStyle::kTextKeys);
}

Result<Message> from_bytes(std::span<const std::uint8_t> bytes) {
  PROBE_ASSIGN(const wire::Value value, wire::from_msgpack(bytes));
  const wire::Value* type = value.find("type");
  const wire::Value* payload = value.find("payload");
  const wire::Value* seq = value.find("seq");
  if (type == nullptr || type->as<std::string>() == nullptr || payload == nullptr ||
      payload->as<wire::Map>() == nullptr || seq == nullptr || seq->as<std::int64_t>() == nullptr) {
    return bad("expected a map with `type`, `payload` and `seq`, got " + wire::describe(value));
  }
  return Message{*type->as<std::string>(), *payload, *seq->as<std::int64_t>()};
}

Result<wire::Value> observation(const Profile& profile, const Request& request,
                                std::string_view task, PictureCoding coding, bool send_state) {
  wire::Map images;
  for (const RequestImage& image : request.images) {
    PROBE_ASSIGN(wire::Value picture, coded(image.pixels, coding));
    images.emplace_back(image.key, std::move(picture));
  }
  wire::Map map{{"images", std::move(images)},
                {profile.prompt_key, request.prompt},
                {"task_name", std::string(task)}};
  if (send_state) {
    if (!request.state.empty()) {
      map.emplace_back(profile.state_key, state_array(profile, request.state));
    }
    map.emplace_back("base_pose", pose_array(Pose{}));
    map.emplace_back("tcp_pose", pose_array(request.proprioception.tcp_in_base));
  }
  wire::Value whole(std::move(map));
  PROBE_TRY(check_distinct_keys(whole));
  return whole;
}

}  // namespace probe::servers::vlaeval
