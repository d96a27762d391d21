// openpi: src/openpi/serving/websocket_policy_server.py; INT-ACT: policy_server_client; RoboArena:
// roboarena/policy_server.py. A text message is an error, except where it answers a reset.
#include "runtime/servers/protocols/openpi.h"

#include <algorithm>

#include "runtime/robot/rotation.h"
#include "runtime/servers/servers.h"
#include "runtime/wire/http.h"
#include "runtime/wire/msgpack.h"
#include "runtime/wire/websocket.h"

namespace probe::servers {
namespace {

// One connection and its messages.
class OpenpiConnection {
 public:
  explicit OpenpiConnection(wire::Endpoint server) : server_(std::move(server)) {}

  // Connects and reads the metadata that every server begins with.
  Result<wire::Value> open(const Profile& profile, const Deadlines& deadlines) {
    wire::WebSocketOptions options;
    options.connect_timeout = deadlines.connect;
    options.largest_message = static_cast<std::size_t>(profile.largest_answer) << 20;
    if (const std::string key = api_key(); !key.empty()) {
      options.headers.emplace_back("Authorization", "Api-Key " + key);
    }
    auto socket = wire::WebSocket::connect(server_, options);
    if (!socket) return explained(socket.failure(), deadlines.connect);
    socket_ = std::move(*socket);
    PROBE_ASSIGN(wire::Value metadata, receive(deadlines.connect));
    if (metadata.as<wire::Map>() == nullptr) {
      return answered("expected the server's metadata first, a map; got " +
                      wire::describe(metadata));
    }
    return metadata;
  }

  void close() { socket_.reset(); }

  // A map with pictures, which a profile's keys could make overwrite each other.
  Result<wire::Value> ask(wire::Map map, wire::Duration timeout) {
    const wire::Value request(std::move(map));
    PROBE_TRY(check_distinct_keys(request));
    return exchange(request, timeout);
  }

  Result<wire::Value> exchange(const wire::Value& request, wire::Duration timeout) {
    PROBE_TRY(send(request, timeout));
    return receive(timeout);
  }

  Status send(const wire::Value& request, wire::Duration timeout) {
    if (!socket_) return bad("there is no connection");
    // It would be taken for this question's answer, and every answer after it be one too old.
    if (socket_->has_message()) {
      PROBE_ASSIGN(const wire::Value message, receive(timeout));
      return bad("the server sent what nothing asked for: " + wire::describe(message));
    }
    return socket_->send(wire::to_msgpack(request, wire::ArrayStyle::kBinKeys), timeout);
  }

  Result<wire::Message> receive_message(wire::Duration timeout) {
    if (!socket_) return bad("there is no connection");
    return socket_->receive(timeout);
  }

  Result<wire::Value> receive(wire::Duration timeout) {
    PROBE_ASSIGN(const wire::Message message, receive_message(timeout));
    if (message.is_text) return answered("the server failed: " + last_lines(message.text()));
    auto value = wire::from_msgpack(message.bytes);
    if (!value) return answered(value.failure().message);
    return value;
  }

 private:
  // Where something listens that does not open a WebSocket, what its health page says of it.
  Failure explained(Failure failure, wire::Duration connect_time) const {
    if (failure.message.find("opening a WebSocket") == std::string::npos) return failure;
    const wire::Duration patience = std::min(connect_time, wire::Duration(2000));
    wire::HttpRequest health;
    health.path = "/healthz";
    const auto answer =
        wire::http_exchange(server_, health, {patience, patience, std::size_t{1} << 16});
    if (!answer) {
      failure.message += "; it does not answer /healthz either: busy, or no policy server";
    } else if (answer->status == 200 && answer->body.starts_with("OK")) {
      failure.message +=
          "; /healthz says OK, so a policy server is there: does it want another VLAPROBE_API_KEY?";
    } else {
      failure.message += "; /healthz is answered with HTTP " + std::to_string(answer->status) +
                         ": another kind of server?";
    }
    return failure;
  }

  wire::Endpoint server_;
  std::unique_ptr<wire::WebSocket> socket_;
};

void append_images(const Request& request, wire::Map* map) {
  for (const RequestImage& image : request.images) map->emplace_back(image.key, image.pixels);
}

// The map's keys for `policy test`.
std::vector<std::string> metadata_remarks(const wire::Value& metadata) {
  const auto* map = metadata.as<wire::Map>();
  if (map == nullptr || map->empty()) return {"metadata: none"};
  std::vector<std::string> lines;
  for (const auto& [key, value] : *map) {
    lines.push_back("metadata " + last_lines(key) + ": " + wire::describe(value));
  }
  return lines;
}

class Openpi : public Transport {
 public:
  Openpi(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), connection_(server) {}

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(metadata_, connection_.open(profile_, deadlines));
    return {};
  }
  void close() override { connection_.close(); }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::Map map;
    append_images(request, &map);
    if (!request.state.empty()) {
      map.emplace_back(profile_.state_key, state_array(profile_, request.state));
    }
    map.emplace_back(profile_.prompt_key, request.prompt);
    PROBE_ASSIGN(const wire::Value answer, connection_.ask(std::move(map), deadlines.answer));
    const wire::Value* actions = answer.find("actions");
    if (actions == nullptr) {
      return bad("expected a map with `actions`, got " + wire::describe(answer));
    }
    return to_actions(*actions);
  }

  std::vector<std::string> remarks() const override { return metadata_remarks(metadata_); }

 private:
  Profile profile_;
  OpenpiConnection connection_;
  wire::Value metadata_;
};

class Intact : public Transport {
 public:
  Intact(const Profile& profile, const wire::Endpoint& server, std::string model)
      : profile_(profile), connection_(server), model_(std::move(model)) {}

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(metadata_, connection_.open(profile_, deadlines));
    // Loading a model takes as long as a first answer.
    return expect_status({{"new_model_path", model_}}, "model switched", deadlines);
  }
  void close() override { connection_.close(); }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::Map map;
    append_images(request, &map);
    if (!request.state.empty()) {
      map.emplace_back(
          profile_.state_key,
          wire::Map{{"agent", wire::Map{{"eef_pos", state_array(profile_, request.state)}}}});
    }
    map.emplace_back(profile_.prompt_key, request.prompt);
    PROBE_ASSIGN(const wire::Value answer, connection_.ask(std::move(map), deadlines.answer));
    if (answer.as<wire::Map>() == nullptr) return to_actions(answer);
    for (const char* key : {"actions", "action"}) {
      if (const wire::Value* actions = answer.find(key)) return to_actions(*actions);
    }
    return bad("expected an array, a list of arrays or a map with `actions` or `action`, got " +
               wire::describe(answer));
  }

  Status end_episode(const policy::EpisodeEnd&, const Deadlines& deadlines) override {
    return expect_status({{"reset", true}}, "reset", deadlines);
  }

  std::vector<std::string> remarks() const override { return metadata_remarks(metadata_); }

 private:
  Status expect_status(wire::Map request, const std::string& wanted, const Deadlines& deadlines) {
    const std::string asked = request.front().first;
    PROBE_ASSIGN(const wire::Value answer,
                 connection_.exchange(std::move(request), deadlines.answer));
    const wire::Value* status = answer.find("status");
    if (status != nullptr && *status == wire::Value(wanted)) return {};
    return answered("`" + asked + "`: expected {\"status\": \"" + wanted + "\"}, got " +
                    wire::describe(status == nullptr ? answer : *status));
  }

  Profile profile_;
  OpenpiConnection connection_;
  std::string model_;
  wire::Value metadata_;
};

// Of the DROID robot, whose arm has seven joints.
constexpr std::size_t kArmJoints = 7;
constexpr std::size_t kFingers = 2;

class RoboArena : public Transport {
 public:
  RoboArena(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), connection_(server) {}

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(config_, connection_.open(profile_, deadlines));
    return {};
  }
  void close() override { connection_.close(); }

  Status adapt(Profile& profile) const override {
    PROBE_TRY(check_action_space());
    PROBE_TRY(choose_images(profile));
    const wire::Value* size = config_.find("image_resolution");
    if (size == nullptr || *size == wire::Value()) return {};
    const auto sides = wire::to_numbers(*size);
    if (!sides || sides->size() != 2 || (*sides)[0] < 1 || (*sides)[1] < 1 || (*sides)[0] > 4096 ||
        (*sides)[1] > 4096) {
      return bad("expected `image_resolution` [height, width] or nil, got " +
                 wire::describe(*size));
    }
    for (ImageRule& image : profile.images) {
      if (image.width > 0) continue;
      image.height = static_cast<int>((*sides)[0]);
      image.width = static_cast<int>((*sides)[1]);
      image.resize = Resize::kPad;
    }
    return {};
  }

  Status begin_episode(const policy::EpisodeStart& start, const Deadlines& deadlines) override {
    session_ = std::string(start.task) + "/" + std::to_string(start.index) + "/" +
               std::to_string(start.seed);
    PROBE_TRY(connection_.send(wire::Map{{"endpoint", "reset"}}, deadlines.answer));
    PROBE_ASSIGN(const wire::Message answer, connection_.receive_message(deadlines.answer));
    if (answer.is_text && answer.text() == "reset successful") return {};
    return bad("reset: expected the text `reset successful`, got " +
               (answer.is_text ? last_lines(answer.text()) : "a binary message"));
  }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::Map map;
    append_images(request, &map);
    const policy::Proprioception& measured = request.proprioception;
    std::vector<double> joints = measured.joints;
    if (joints.size() >= kFingers) joints.resize(joints.size() - kFingers);
    joints.resize(kArmJoints, 0.0);
    const Vec3& at = measured.tcp_in_base.position;
    const Vec3 rpy = robot::to_rpy(measured.tcp_in_base.rotation);
    map.emplace_back("observation/joint_position", state_array(profile_, joints));
    map.emplace_back("observation/cartesian_position",
                     state_array(profile_, {at.x(), at.y(), at.z(), rpy.x(), rpy.y(), rpy.z()}));
    map.emplace_back("observation/gripper_position",
                     state_array(profile_, {1 - measured.openness}));  // DROID: 1 is closed
    if (wants("needs_session_id")) map.emplace_back("session_id", session_);
    map.emplace_back(profile_.prompt_key, request.prompt);
    map.emplace_back("endpoint", "infer");
    PROBE_ASSIGN(const wire::Value answer, connection_.ask(std::move(map), deadlines.answer));
    const wire::Value* actions = answer.find("actions");
    return to_actions(actions == nullptr ? answer : *actions);
  }

  std::vector<std::string> remarks() const override { return metadata_remarks(config_); }

 private:
  bool wants(std::string_view what) const {
    const wire::Value* value = config_.find(what);
    return value != nullptr && *value == wire::Value(true);
  }

  Status check_action_space() const {
    const wire::Value* space = config_.find("action_space");
    if (space == nullptr || *space == wire::Value("cartesian_velocity")) return {};
    return Failure{Fault::kUsage,
                   "the server's `action_space` is " + wire::describe(*space) +
                       "; only \"cartesian_velocity\", changes of the end effector, can be "
                       "done here",
                   ""};
  }

  // The profile's pictures that the server wants, and an error where it wants one more.
  Status choose_images(Profile& profile) const {
    std::vector<std::string> wanted;
    const wire::Value* count = config_.find("n_external_cameras");
    const auto* cameras = count == nullptr ? nullptr : count->as<std::int64_t>();
    if (cameras == nullptr) return {};
    for (std::int64_t i = 0; i < std::clamp<std::int64_t>(*cameras, 0, 16); ++i) {
      const std::string key = "observation/exterior_image_" + std::to_string(i);
      wanted.push_back(key + "_left");
      if (wants("needs_stereo_camera")) wanted.push_back(key + "_right");
    }
    if (wants("needs_wrist_camera")) {
      wanted.emplace_back("observation/wrist_image_left");
      if (wants("needs_stereo_camera")) wanted.emplace_back("observation/wrist_image_right");
    }
    std::vector<ImageRule> images;
    for (const std::string& key : wanted) {
      const auto rule = std::find_if(profile.images.begin(), profile.images.end(),
                                     [&](const ImageRule& image) { return image.key == key; });
      if (rule == profile.images.end()) {
        return Failure{
            Fault::kUsage,
            "the server wants the picture `" + key + "`, for which the profile has no `image` line",
            ""};
      }
      images.push_back(*rule);
    }
    profile.images = std::move(images);
    return {};
  }

  Profile profile_;
  OpenpiConnection connection_;
  wire::Value config_;
  std::string session_;
};

}  // namespace

Result<std::unique_ptr<Transport>> make_openpi(const Profile& profile,
                                               const wire::Endpoint& server) {
  return std::unique_ptr<Transport>(std::make_unique<Openpi>(profile, server));
}

Result<std::unique_ptr<Transport>> make_intact(const Profile& profile,
                                               const wire::Endpoint& server) {
  const auto model = server.options.find("model");
  if (model == server.options.end() || model->second.empty()) {
    return Failure{Fault::kUsage,
                   "an INT-ACT server begins without a model: write "
                   "`intact://HOST:PORT?model=PATH`, PATH as the server sees it",
                   "--policy"};
  }
  return std::unique_ptr<Transport>(std::make_unique<Intact>(profile, server, model->second));
}

Result<std::unique_ptr<Transport>> make_roboarena(const Profile& profile,
                                                  const wire::Endpoint& server) {
  return std::unique_ptr<Transport>(std::make_unique<RoboArena>(profile, server));
}

}  // namespace probe::servers
