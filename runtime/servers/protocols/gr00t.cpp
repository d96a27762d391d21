// NVIDIA/Isaac-GR00T: gr00t/policy/server_client.py (n1.6) and gr00t/eval/service.py (n1.5).
#include "runtime/servers/protocols/gr00t.h"

#include <array>
#include <span>

#include "runtime/servers/api_key.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/wire/msgpack.h"
#include "runtime/wire/zmq.h"

namespace probe::servers {
namespace {

constexpr std::string_view kNested = "n1.6_nested", kN15 = "n1.5";
constexpr std::array<std::string_view, 7> kActionNames = {"x",     "y",   "z",      "roll",
                                                          "pitch", "yaw", "gripper"};
constexpr std::array<Gr00tState, 8> kPaddedStates = {
    {{"x"}, {"y"}, {"z"}, {"roll"}, {"pitch"}, {"yaw"}, {"pad"}, {"gripper"}}};
constexpr std::array<Gr00tState, 7> kStates = {
    {{"x"}, {"y"}, {"z"}, {"roll"}, {"pitch"}, {"yaw"}, {"gripper"}}};
// Of LIBERO the turn is an axis times an angle, under these names, and both fingers are one entry.
constexpr std::array<Gr00tState, 7> kLiberoStates = {
    {{"x"}, {"y"}, {"z"}, {"roll"}, {"pitch"}, {"yaw"}, {"gripper", 2}}};

// The array with leading dimensions of 1: batch and, from n1.6 on, time.
wire::Array led(wire::Array array, Gr00tForm form) {
  const std::size_t count = form == Gr00tForm::kN15 ? 1 : 2;
  array.shape.insert(array.shape.begin(), count, 1);
  return array;
}

Status check_no_error(const wire::Value& answer) {
  const wire::Value* error = answer.find("error");
  if (error == nullptr) return {};
  const auto* text = error->as<std::string>();
  return bad("the server failed: " +
             (text == nullptr ? wire::describe(*error) : last_lines(*text)));
}

// Beside the map in a list of two, or alone.
const wire::Value* action_map(const wire::Value& answer) {
  const auto* list = answer.as<wire::List>();
  if (list == nullptr) return &answer;
  return list->empty() ? nullptr : &list->front();
}

class Gr00t : public Transport {
 public:
  Gr00t(const Profile& profile, const wire::Endpoint& server, Gr00tForm form)
      : profile_(profile), server_(server), form_(form) {}

  Status open(const Deadlines& deadlines) override {
    wire::ZmqOptions options;
    options.connect_timeout = deadlines.connect;
    options.largest_message = static_cast<std::size_t>(profile_.largest_answer) << 20;
    PROBE_ASSIGN(socket_, wire::ZmqRequester::create(server_, options));
    PROBE_ASSIGN(const wire::Value pong, exchange({{"endpoint", "ping"}}, deadlines.connect));
    if (pong.as<wire::Map>() != nullptr) return {};
    return answered("ping: expected a map, got " + wire::describe(pong));
  }
  void close() override { socket_.reset(); }

  Status begin_episode(const policy::EpisodeStart&, const Deadlines& deadlines) override {
    return reset(deadlines);
  }
  Status end_episode(const policy::EpisodeEnd&, const Deadlines& deadlines) override {
    return reset(deadlines);
  }
  // N1.5 has none and keeps nothing.
  Status reset(const Deadlines& deadlines) {
    if (form_ == Gr00tForm::kN15) return {};
    auto reset = exchange({{"endpoint", "reset"}, {"data", wire::Map{{"options", wire::Value()}}}},
                          deadlines.answer);
    if (!reset) {
      Failure failure = reset.failure();
      failure.message = "reset: " + failure.message;
      return failure;
    }
    return {};
  }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::Value data = gr00t_observation(form_, profile_, request);
    PROBE_TRY(check_distinct_keys(data));
    if (form_ != Gr00tForm::kN15) {
      data = wire::Map{{"observation", std::move(data)}, {"options", wire::Value()}};
    }
    PROBE_ASSIGN(
        const wire::Value answer,
        exchange({{"endpoint", "get_action"}, {"data", std::move(data)}}, deadlines.answer));
    return gr00t_actions(answer);
  }

 private:
  Result<wire::Value> exchange(wire::Map request, wire::Duration timeout) {
    if (!socket_) return bad("there is no connection");
    if (const std::string key = api_key(); !key.empty()) request.emplace_back("api_token", key);
    PROBE_ASSIGN(
        const wire::Bytes bytes,
        socket_->ask(wire::to_msgpack(std::move(request), wire::ArrayStyle::kNpy), timeout));
    PROBE_ASSIGN(wire::Value answer, wire::from_msgpack(bytes));
    if (auto fine = check_no_error(answer); !fine) return answered(fine.failure().message);
    return answer;
  }

  Profile profile_;
  wire::Endpoint server_;
  Gr00tForm form_;
  std::unique_ptr<wire::ZmqRequester> socket_;
};

}  // namespace

std::span<const Gr00tState> gr00t_states(StateLayout layout) {
  if (layout == StateLayout::kXyzRpyOpenness) return kStates;
  if (layout == StateLayout::kXyzRpyPadOpenness) return kPaddedStates;
  if (layout == StateLayout::kLibero) return kLiberoStates;
  return {};
}

std::string gr00t_nested_image_key(std::string_view key) {
  constexpr std::string_view kPrefix = "video.";
  return std::string(key.starts_with(kPrefix) ? key.substr(kPrefix.size()) : key);
}

wire::Value gr00t_observation(Gr00tForm form, const Profile& profile, const Request& request) {
  const bool is_nested = form == Gr00tForm::kN16Nested;
  wire::Map video, state, language;
  for (const RequestImage& image : request.images) {
    video.emplace_back(is_nested ? gr00t_nested_image_key(image.key) : image.key,
                       led(image.pixels, form));
  }
  std::size_t begin = 0;
  for (const Gr00tState& entry : gr00t_states(profile.state_layout)) {
    if (begin + entry.count > request.state.size()) break;
    const auto first = request.state.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::vector<double> numbers(first, first + static_cast<std::ptrdiff_t>(entry.count));
    const std::string prefix = is_nested ? "" : profile.state_key + ".";
    state.emplace_back(prefix + std::string(entry.name), led(state_array(profile, numbers), form));
    begin += entry.count;
  }
  const wire::List text{request.prompt};
  if (is_nested) {
    language.emplace_back(profile.prompt_key, wire::List{text});
    return wire::Map{{"video", std::move(video)},
                     {"state", std::move(state)},
                     {"language", std::move(language)}};
  }
  wire::Map flat = std::move(video);
  for (auto& entry : state) flat.push_back(std::move(entry));
  flat.emplace_back(profile.prompt_key, text);
  return flat;
}

Result<std::vector<RawAction>> gr00t_actions(const wire::Value& answer) {
  const wire::Value* map = action_map(answer);
  if (map == nullptr || map->as<wire::Map>() == nullptr) {
    return bad("expected a map of actions, got " + wire::describe(answer));
  }
  PROBE_TRY(check_no_error(*map));
  std::vector<std::vector<double>> columns;
  for (const std::string_view name : kActionNames) {
    const wire::Value* column = map->find("action." + std::string(name));
    if (column == nullptr) column = map->find(name);
    if (column == nullptr) {
      return bad("expected `action." + std::string(name) + "` among others, got " +
                 wire::describe(*map));
    }
    auto numbers = wire::to_numbers(*column);
    if (!numbers) {
      return bad("`action." + std::string(name) + "`: " + numbers.failure().message);
    }
    columns.push_back(std::move(*numbers));
    if (columns.back().size() != columns.front().size()) {
      return bad("expected actions of one length, got " + std::to_string(columns.front().size()) +
                 " of `action.x` and " + std::to_string(columns.back().size()) + " of `action." +
                 std::string(name) + "`");
    }
  }
  const std::size_t count = columns.front().size();
  std::vector<double> rows;
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::vector<double>& column : columns) rows.push_back(column[i]);
  }
  return to_actions(wire::array_f64({static_cast<std::int64_t>(count), 7}, rows));
}

namespace {

Result<std::unique_ptr<Transport>> make_gr00t(const Profile& profile,
                                              const wire::Endpoint& server) {
  Gr00tForm form = Gr00tForm::kN16;
  if (profile.dialect == kN15) {
    form = Gr00tForm::kN15;
  } else if (profile.dialect == kNested) {
    form = Gr00tForm::kN16Nested;
  }
  if (profile.state_layout != StateLayout::kNone && gr00t_states(profile.state_layout).empty()) {
    return Failure{Fault::kUsage,
                   "GR00T is sent its state entry by entry: `state.layout` is "
                   "xyz_rpy_pad_openness, xyz_rpy_openness, libero or none",
                   "--policy"};
  }
  return std::unique_ptr<Transport>(std::make_unique<Gr00t>(profile, server, form));
}

// Number by number, or each in a map of its kind.
std::vector<KeyUse> gr00t_key_uses(const Profile& profile) {
  const bool is_nested = profile.dialect == kNested;
  std::vector<KeyUse> uses = image_key_uses(profile);
  if (is_nested) {
    for (KeyUse& use : uses) {
      use.map = "video";
      use.key = gr00t_nested_image_key(use.key);
    }
  } else {
    for (const Gr00tState& entry : gr00t_states(profile.state_layout))
      uses.push_back(state_key_use(profile.state_key + "." + std::string(entry.name)));
  }
  uses.push_back(prompt_key_use(profile));
  if (is_nested) uses.back().map = "language";
  return uses;
}

bool gr00t_has_reset(std::string_view dialect) { return dialect != kN15; }

constexpr std::array<std::string_view, 3> kGr00tDialects = {"n1.6", kNested, kN15};

}  // namespace

constinit const ProtocolRow gr00t_row{
    .word = "gr00t",
    .argument = "//HOST:PORT",
    .meaning = "a GR00T server",
    .port = "5555",
    .options = {},
    .fixed_keys = {},
    .key_uses = gr00t_key_uses,
    .make = make_gr00t,
    .serve = serve_gr00t,
    .dialects = kGr00tDialects,
    // As rendered: an episode is known by its first picture.
    .served_options = "&chunk.length=any&chunk.use=all&image=first%20-%3E%20video.image_0",
    .has_one_place = true,
    .carrier = Carrier::kZmq,
    .has_reset = gr00t_has_reset,
};

}  // namespace probe::servers
