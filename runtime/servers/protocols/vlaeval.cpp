// allenai/vla-evaluation-harness: src/vla_eval/connection.py, model_servers/serve.py. An error is a
// message like any other there; a text is not.
#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

#include "runtime/base/clock.h"
#include "runtime/base/json.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/servers/protocols/vlaeval_messages.h"
#include "runtime/wire/http.h"
#include "runtime/wire/websocket.h"

namespace probe::servers {
namespace {

using Clock = std::chrono::steady_clock;
using vlaeval::Message;
using vlaeval::PictureCoding;

constexpr std::int64_t kProtocolVersion = 1;

bool is_this_machine(const std::string& host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

struct Choices {
  PictureCoding coding = PictureCoding::kPng;
  std::optional<bool> send_state;  // nothing: as the server asks
  bool without_wrist = false;      // though the server asks for a wrist picture
};

Result<Choices> read_choices(const wire::Endpoint& server) {
  Choices choices;
  if (is_this_machine(server.host)) choices.coding = PictureCoding::kRaw;
  if (const auto it = server.options.find("pictures"); it != server.options.end()) {
    if (it->second == "raw") {
      choices.coding = PictureCoding::kRaw;
    } else if (it->second == "png") {
      choices.coding = PictureCoding::kPng;
    } else if (it->second == "jpeg") {
      choices.coding = PictureCoding::kJpeg;
    } else {
      return Failure{Fault::kUsage, "`pictures` is raw, png or jpeg, not `" + it->second + "`",
                     "--policy"};
    }
  }
  if (const auto it = server.options.find("send_state"); it != server.options.end()) {
    if (it->second != "true" && it->second != "false") {
      return Failure{Fault::kUsage, "`send_state` is true or false, not `" + it->second + "`",
                     "--policy"};
    }
    choices.send_state = it->second == "true";
  }
  if (const auto it = server.options.find("send_wrist_image"); it != server.options.end()) {
    if (it->second != "false") {
      return Failure{Fault::kUsage,
                     "`send_wrist_image` is false, not `" + it->second +
                         "`: a picture is sent by a line `image = CAMERA -> wrist`",
                     "--policy"};
    }
    choices.without_wrist = true;
  }
  return choices;
}

// What a server may ask for in its hello besides state and wrist picture, and what becomes of it.
struct Wish {
  std::string_view name;
  std::string (*what_is_done)(const wire::Value& asked);  // empty: it is as asked
};

std::string is_true(const wire::Value& asked, const char* otherwise) {
  return asked == wire::Value(true) ? "" : otherwise;
}

constexpr Wish kWishes[] = {
    {"max_episode_steps",
     [](const wire::Value&) -> std::string { return "episodes are as long as the plan says"; }},
    {"success_mode",
     [](const wire::Value&) -> std::string {
       return "the plan's metrics say what success is, over every control step";
     }},
    {"deterministic_episodes",
     [](const wire::Value& asked) { return is_true(asked, "the plan fixes where things start"); }},
    {"env_seed",
     [](const wire::Value&) -> std::string { return "the plan fixes where things start"; }},
    {"seed", [](const wire::Value&) -> std::string { return "the plan fixes where things start"; }},
    // What cannot be done of these is refused in adapt().
    {"control_mode", [](const wire::Value&) -> std::string { return ""; }},
    {"absolute_action", [](const wire::Value&) -> std::string { return ""; }},
    {"gripper_mode", [](const wire::Value&) -> std::string { return ""; }},
    // States are sent with w >= 0, which is what it asks for.
    {"quat_no_antipodal",
     [](const wire::Value& asked) { return is_true(asked, "w is never < 0"); }},
};

class VlaEval : public Transport {
 public:
  VlaEval(const Profile& profile, const wire::Endpoint& server, const Choices& choices)
      : profile_(profile), server_(server), choices_(choices) {}

  void gather(const BatchLimits& limits) override { gathering_ = limits; }

  Status open(const Deadlines& deadlines) override {
    PROBE_TRY(tell_batches(deadlines));
    wire::WebSocketOptions options;
    options.connect_timeout = deadlines.connect;
    options.largest_message = static_cast<std::size_t>(profile_.largest_answer) << 20;
    PROBE_ASSIGN(socket_, wire::WebSocket::connect(server_, options));
    seq_ = 0;
    PROBE_TRY(send("hello",
                   wire::Map{{"harness_version", "vlaprobe"},
                             {"protocol_version", kProtocolVersion},
                             {"benchmark", "vlaprobe"}},
                   deadlines.connect));
    PROBE_ASSIGN(const Message hello,
                 answer_to(seq_, Clock::now() + deadlines.connect, deadlines.connect));
    if (hello.type != "hello")
      return answered("hello: expected a `hello`, got `" + last_lines(hello.type) + "`");
    hello_ = hello.payload;
    const wire::Value* version = hello_.find("protocol_version");
    if (version != nullptr && *version != wire::Value(kProtocolVersion)) {
      return Failure{
          Fault::kUsage,
          "the server's `protocol_version` is " + wire::describe(*version) + ", vlaprobe speaks 1",
          ""};
    }
    return {};
  }

  Status adapt(Profile& profile) const override {
    PROBE_TRY(check_wishes(profile));
    PROBE_TRY(choose_meaning(profile));
    if (!sends_state()) profile.state_layout = StateLayout::kNone;
    if (!asks_for("send_wrist_image", true)) {
      // Explicitly not wanted; a server that says nothing gets what the profile has.
      if (asked("send_wrist_image") != nullptr) {
        std::erase_if(profile.images, [](const ImageRule& image) { return is_wrist(image); });
      }
      if (profile.images.empty()) {
        return Failure{Fault::kUsage,
                       "the server wants no wrist picture, and the profile has no other", ""};
      }
    }
    return {};
  }

  void close() override { socket_.reset(); }

  Status begin_episode(const policy::EpisodeStart& start, const Deadlines& deadlines) override {
    task_ = std::string(start.task);
    started_ = Clock::now();
    return send("episode_start",
                wire::Map{{"task", wire::Map{{"name", task_},
                                             {"task_name", task_},
                                             {"task_description", std::string(start.prompt)},
                                             {"episode_idx", start.index}}}},
                deadlines.answer);
  }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    const auto until = Clock::now() + deadlines.answer;
    PROBE_ASSIGN(wire::Value payload,
                 vlaeval::observation(profile_, request, task_, choices_.coding, sends_state()));
    PROBE_TRY(send("observation", std::move(payload), deadlines.answer));
    PROBE_ASSIGN(const Message answer, answer_to(seq_, until, deadlines.answer));
    if (answer.type != "action") {
      return bad("expected an `action`, got `" + last_lines(answer.type) + "`");
    }
    for (const char* key : {"actions", "action"}) {
      if (const wire::Value* actions = answer.payload.find(key)) return to_actions(*actions);
    }
    return bad("expected an action with `actions` or `action`, got " +
               wire::describe(answer.payload));
  }

  Status end_episode(const policy::EpisodeEnd& end, const Deadlines& deadlines) override {
    const double elapsed = seconds_since(started_);
    return send("episode_end",
                wire::Map{{"metrics", wire::Map{{"success", end.success}}},
                          {"steps", end.steps},
                          {"elapsed_sec", elapsed}},
                deadlines.answer);
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> lines;
    if (rotation_format() == "euler_xyz" && profile_.action_rotation != RotationForm::kEuler &&
        !is_base_pose()) {
      lines.emplace_back(
          "the server's action_spec says its rotations are euler_xyz; they are handed on as "
          "rotation vectors, as vla-eval's own benchmark does (`action.rotation = euler` reads "
          "them "
          "as they are meant)");
    }
    const auto* wishes = params() == nullptr ? nullptr : params()->as<wire::Map>();
    if (wishes == nullptr) return lines;
    for (const auto& [name, asked] : *wishes) {
      std::string done = what_is_done(name, asked);
      if (done.empty()) continue;
      lines.push_back("the server asks for " + last_lines(name) + " = " + wire::describe(asked) +
                      ": " + done);
    }
    return lines;
  }

  std::vector<std::string> remarks() const override {
    std::vector<std::string> lines;
    const auto* map = hello_.as<wire::Map>();
    if (map == nullptr) return lines;
    for (const auto& [key, value] : *map) {
      const auto* parts = value.as<wire::Map>();
      if (parts == nullptr) {
        lines.push_back(last_lines(key) + ": " + wire::describe(value));
        continue;
      }
      for (const auto& [name, part] : *parts) {
        lines.push_back(last_lines(key) + " " + last_lines(name) + ": " + wire::describe(part));
      }
    }
    return lines;
  }

 private:
  static constexpr std::string_view kDeltaMode =
      "arm_pd_ee_target_delta_pose_align2_gripper_pd_joint_pos";
  // The harness's patch for X-VLA (docker/xvla_absolute_ee.patch): poses in the robot's base frame
  // whose rotation is roll pitch yaw, whatever the server's action_spec says.
  static constexpr std::string_view kBasePoseMode =
      "arm_pd_ee_target_base_pose_gripper_pd_joint_pos";

  static std::string text_of(const wire::Value* value) {
    const auto* text = value == nullptr ? nullptr : value->as<std::string>();
    return text == nullptr ? "" : *text;
  }
  // action_spec's word for the format of a part: "delta_xyz", "euler_xyz", "raw"; empty: none.
  std::string format_of(std::string_view part) const {
    const wire::Value* spec = hello_.find("action_spec");
    const wire::Value* found = spec == nullptr ? nullptr : spec->find(part);
    return text_of(found == nullptr ? nullptr : found->find("format"));
  }
  std::string rotation_format() const { return format_of("rotation"); }
  bool is_base_pose() const { return text_of(asked("control_mode")) == kBasePoseMode; }

  Failure not_done(const std::string& what, const std::string& is) const {
    return {Fault::kUsage,
            "the server asks for " + what + " = " + last_lines(is) + ", which is not done here",
            ""};
  }

  Failure contradicted(const std::string& what, const std::string& way_out) const {
    return {Fault::kUsage, what + "; " + way_out, ""};
  }

  // What would be another policy's input or output without a word of the profile.
  Status check_wishes(const Profile& profile) const {
    if (const wire::Value* history = asked("image_history")) {
      const auto* count = history->as<std::int64_t>();
      if (*history != wire::Value(false) && (count == nullptr || *count > 1))
        return not_done("image_history", wire::describe(*history));
    }
    const bool has_wrist = std::any_of(profile.images.begin(), profile.images.end(), is_wrist);
    if (asks_for("send_wrist_image", true) && !has_wrist && !choices_.without_wrist) {
      return contradicted("the server asks for send_wrist_image = true, and the profile has none",
                          "a line `image = CAMERA -> wrist` sends one, `?send_wrist_image=false` "
                          "runs without");
    }
    const wire::Value* spec = hello_.find("action_spec");
    const auto* parts = spec == nullptr ? nullptr : spec->as<wire::Map>();
    if (parts != nullptr && profile.action_form == ActionForm::kUnsaid) {
      for (const auto& [name, part] : *parts) {
        if (name != "position" && name != "rotation" && name != "gripper")
          return not_done("an action_spec with", name);
      }
    }
    const bool is_inverted = profile.action_gripper == GripperRange::kSignedInverted ||
                             profile.action_gripper == GripperRange::kUnitInverted;
    const std::string gripper = format_of("gripper");
    const bool closes = gripper == "binary_close_positive";
    const bool opens = gripper == "binary_close_negative" || gripper == "binary_open_positive";
    if ((closes && !is_inverted) || (opens && is_inverted)) {
      return contradicted("the server's action_spec says its gripper is " + gripper +
                              ", and the profile reads it the other way round",
                          closes ? "say `action.gripper = signed_inverted` or `unit_inverted`"
                                 : "say `action.gripper = signed` or `unit`");
    }
    return {};
  }

  // Changes of the pose or poses, and what their rotation is: by the control mode where the server
  // names one, since that is what its numbers were tried with, else by its action_spec. Where
  // neither says, vla-eval's benchmark does changes. The profile's word stands above all.
  Status choose_meaning(Profile& profile) const {
    const std::string mode = text_of(asked("control_mode")), position = format_of("position");
    const std::string rotation = rotation_format(), gripper = text_of(asked("gripper_mode"));
    if (!gripper.empty() && gripper != "binary") return not_done("gripper_mode", gripper);
    if (profile.action_form == ActionForm::kUnsaid) {
      if (!mode.empty() && mode != kDeltaMode && mode != kBasePoseMode)
        return not_done("control_mode", mode);
      if (!position.empty() && position != "delta_xyz" && position != "absolute_xyz" &&
          position != "raw") {
        return not_done("a position in the form", position);
      }
      const bool wants_poses = mode.empty()
                                   ? asks_for("absolute_action", true) || position == "absolute_xyz"
                                   : mode == kBasePoseMode;
      if (mode.empty() && asks_for("absolute_action", true) && position == "delta_xyz") {
        return contradicted(
            "the server asks for absolute_action = true, and its action_spec says "
            "its positions are delta_xyz",
            "say `action.form = absolute` or `delta`");
      }
      if (mode == kDeltaMode && position == "absolute_xyz")
        return not_done("positions that are absolute_xyz, and for control_mode", mode);
      profile.action_form = wants_poses ? ActionForm::kAbsolute : ActionForm::kDelta;
    }
    if (profile.action_units == ActionUnits::kUnsaid) profile.action_units = ActionUnits::kMetric;
    if (profile.action_rotation != RotationForm::kUnsaid) return {};
    if (!rotation.empty() && rotation != "euler_xyz" && rotation != "axis_angle" &&
        rotation != "raw") {
      return not_done("a rotation in the form", rotation);
    }
    if (!is_base_pose() && profile.action_form == ActionForm::kDelta && rotation == "euler_xyz") {
      return contradicted(
          "the server's action_spec says the rotations of its changes are "
          "euler_xyz, and vla-eval's own benchmark takes them for rotation vectors",
          "say `action.rotation = vector`, as published, or `euler`, as meant");
    }
    const bool is_euler =
        is_base_pose() || (profile.action_form == ActionForm::kAbsolute && rotation == "euler_xyz");
    profile.action_rotation = is_euler ? RotationForm::kEuler : RotationForm::kVector;
    return {};
  }

  const wire::Value* params() const { return hello_.find("observation_params"); }
  const wire::Value* asked(std::string_view name) const {
    return params() == nullptr ? nullptr : params()->find(name);
  }
  bool asks_for(std::string_view name, bool what) const {
    const wire::Value* value = asked(name);
    return value != nullptr && *value == wire::Value(what);
  }
  static bool is_wrist(const ImageRule& image) {
    return image.key.find("wrist") != std::string::npos;
  }

  // SimplerEnv's benchmark there sends no state unless it is asked to.
  bool sends_state() const { return choices_.send_state.value_or(asks_for("send_state", true)); }

  std::string what_is_done(std::string_view name, const wire::Value& wanted) const {
    if (name == "send_state") {
      if (wanted != wire::Value(sends_state())) {
        return sends_state() ? "it is sent, because `send_state` says so"
                             : "it is not sent, because `send_state` says so";
      }
      return sends_state() && profile_.state_layout == StateLayout::kNone
                 ? "the poses are sent, and no state, because the profile has `state.layout = none`"
                 : "";
    }
    if (name == "send_wrist_image") {
      const bool has = std::any_of(profile_.images.begin(), profile_.images.end(), is_wrist);
      return wanted == wire::Value(true) && !has
                 ? "none is sent; a line `image = CAMERA -> wrist` of a profile would"
                 : "";
    }
    for (const Wish& wish : kWishes) {
      if (wish.name == name) return wish.what_is_done(wanted);
    }
    return "vlaprobe does not know it";
  }

  // model_servers/serve.py: GET /config changes how the running server gathers, and says what
  // holds.
  Status tell_batches(const Deadlines& deadlines) const {
    const BatchLimits& wanted = gathering_;
    if (wanted.most <= 1) return {};
    wire::HttpRequest page;
    page.path = "/config?max_batch_size=" + std::to_string(wanted.most) +
                "&max_wait_time=" + std::to_string(static_cast<double>(wanted.wait.count()) / 1000);
    PROBE_ASSIGN(const wire::HttpResponse said,
                 wire::http_exchange(server_, page,
                                     {deadlines.connect, deadlines.connect, std::size_t{1} << 16}));
    const Json json = Json::parse(said.body);
    const Json* config = json.is_object() ? json.find("config") : nullptr;
    const Json* most =
        config != nullptr && config->is_object() ? config->find("max_batch_size") : nullptr;
    if (said.status == 200 && most != nullptr && most->is_number_integer() &&
        most->get<int>() == wanted.most) {
      return {};
    }
    // One that is starting may say so; any other answer stays as it is.
    return Failure{said.status >= 500 ? Fault::kPolicy : Fault::kUsage,
                   "the server does not gather batches of " + std::to_string(wanted.most) +
                       ": /config is answered with HTTP " + std::to_string(said.status) + ", `" +
                       last_lines(said.body) + "`; ask without `batch`",
                   ""};
  }

  Status send(std::string type, wire::Value payload, wire::Duration timeout) {
    if (!socket_) return bad("there is no connection");
    const Message message{std::move(type), std::move(payload), ++seq_};
    return socket_->send(vlaeval::to_bytes(message, unix_seconds()), timeout);
  }

  // The message with that number. An error is the answer to whatever it was sent for: an announced
  // episode that failed is heard of here.
  Result<Message> answer_to(std::int64_t seq, Clock::time_point until, wire::Duration stated) {
    while (true) {
      const auto left = std::chrono::ceil<wire::Duration>(until - Clock::now());
      if (left <= wire::Duration::zero()) return bad("no answer in " + wire::seconds_text(stated));
      auto received = socket_->receive(left);
      if (!received && Clock::now() >= until) {
        return bad("no answer in " + wire::seconds_text(stated));
      }
      if (!received) return received.failure();
      if (received->is_text) return answered("the server failed: " + last_lines(received->text()));
      auto read = vlaeval::from_bytes(received->bytes);
      if (!read) return answered(read.failure().message);
      Message message = std::move(*read);
      if (message.type == "error") {
        const wire::Value* error = message.payload.find("error");
        const auto* text = error == nullptr ? nullptr : error->as<std::string>();
        return answered("the server failed: " +
                        (text == nullptr ? wire::describe(message.payload) : last_lines(*text)));
      }
      if (message.seq == seq) return message;
    }
  }

  Profile profile_;
  wire::Endpoint server_;
  Choices choices_;
  // What its server is told of batches, which it gathers from all connections
  // (model_servers/predict.py).
  BatchLimits gathering_{.most = 1};
  std::unique_ptr<wire::WebSocket> socket_;
  std::int64_t seq_ = 0;
  wire::Value hello_;
  std::string task_;
  Clock::time_point started_;
};

Result<std::unique_ptr<Transport>> make_vlaeval(const Profile& profile,
                                                const wire::Endpoint& server) {
  PROBE_ASSIGN(const Choices choices, read_choices(server));
  return std::unique_ptr<Transport>(std::make_unique<VlaEval>(profile, server, choices));
}

// Pictures are in a map of their own.
std::vector<KeyUse> vlaeval_key_uses(const Profile& profile) {
  std::vector<KeyUse> uses = plain_key_uses(profile);
  for (KeyUse& use : uses) {
    if (use.field.starts_with("image")) use.map = "images";
  }
  return uses;
}

// `pictures`: raw, png, jpeg; else raw to this machine and png to others. `send_state`: true,
// false; else what the server asks for. `send_wrist_image`: false, where it asks for what there is
// not.
constexpr std::array<std::string_view, 3> kVlaEvalOptions = {"pictures", "send_state",
                                                             "send_wrist_image"};
constexpr std::array<std::string_view, 4> kVlaEvalKeys = {"images", "task_name", "base_pose",
                                                          "tcp_pose"};

}  // namespace

constinit const ProtocolRow vlaeval_row{
    .word = "vlaeval",
    .argument = "//HOST:PORT",
    .meaning = "a vla-eval server",
    .port = "8000",
    .options = kVlaEvalOptions,
    .fixed_keys = kVlaEvalKeys,
    .key_uses = vlaeval_key_uses,
    .make = make_vlaeval,
    .serve = serve_vlaeval,
    .served_options = {},
    .has_reset = always_has_reset,
    .is_timed = true,
    .batches = Batches::kGathered,
};

}  // namespace probe::servers
