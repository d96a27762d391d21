// huggingface/lerobot: src/lerobot/async_inference/policy_server.py, gRPC with pickles. Its server
// has one place for an observation and one policy for all who ask it, so the connections of a run
// take turns. A timestep there tells which observation an answer is for; here it is made from the
// observation itself, so that an answer to any other one, of whomever, is refused.
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/lerobot_messages.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/servers/shared_model.h"

namespace probe::servers {
namespace {

constexpr std::string_view kPicturePrefix = "observation.images.";
constexpr std::string_view kStateFeature = "observation.state";
constexpr std::string_view kInstruction = "task";
constexpr std::size_t kMostActionBytes = 4096;  // of one action, which has seven numbers
constexpr int kWholeChunk = 1000;               // more than any policy has: all of it

// What an observation calls a picture, and each number of the state.
std::string picture_name(std::string_view feature) {
  return std::string(feature.substr(kPicturePrefix.size()));
}
std::string number_name(std::string_view tag, std::size_t index) {
  return "state." + std::string(tag) + "." + std::to_string(index);
}

// A server takes an observation apart by the names that came with the policy which it loaded last:
// of another policy, by whomever, these names are not to be found, and there is no answer.
std::string tag_of(const lerobot::PolicySetup& setup) {
  constexpr std::size_t kLength = 8;
  return to_hex(sha256(setup.type + "\n" + setup.model + "\n" + setup.device + "\n" +
                       std::to_string(setup.chunk)))
      .substr(0, kLength);
}

// Of the observation's content; less than 2^62, so that what is counted from it stays a number of
// 64 bits.
std::int64_t timestep_of(const Request& request) {
  Hasher hasher;
  hasher.hash(sha256(request.prompt));
  for (const RequestImage& image : request.images) {
    hasher.hash(sha256(image.key));
    hasher.bytes(std::as_bytes(std::span(image.pixels.bytes)));
  }
  hasher.bytes(std::as_bytes(std::span(request.state)));
  return static_cast<std::int64_t>(big_endian_number(hasher.finish()) >> 2);
}

// As LeRobot's data sets say what an observation holds.
wire::Map features_of(const Request& request, std::string_view tag) {
  wire::Map features;
  wire::List names;
  for (std::size_t i = 0; i < request.state.size(); ++i) names.emplace_back(number_name(tag, i));
  const auto count = static_cast<std::int64_t>(names.size());
  features.emplace_back(
      std::string(kStateFeature),
      wire::Map{{"dtype", "float32"}, {"shape", wire::List{count}}, {"names", std::move(names)}});
  for (const RequestImage& image : request.images) {
    wire::List shape;
    for (const std::int64_t length : image.pixels.shape) shape.emplace_back(length);
    features.emplace_back(image.key,
                          wire::Map{{"dtype", "image"},
                                    {"shape", std::move(shape)},
                                    {"names", wire::List{"height", "width", "channels"}}});
  }
  return features;
}

class LeRobot : public Transport {
 public:
  LeRobot(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), server_(server) {
    setup_.type = server.options.at("type");
    setup_.model = server.options.at("model");
    const auto device = server.options.find("device");
    setup_.device = device == server.options.end() ? "cuda" : device->second;
    setup_.chunk = profile.chunk_length > 0 ? profile.chunk_length : kWholeChunk;
    tag_ = tag_of(setup_);
  }

  void share(std::shared_ptr<SharedModel> shared) override { shared_ = std::move(shared); }

  Status open(const Deadlines& deadlines) override {
    wire::GrpcOptions options;
    options.connect_timeout = deadlines.connect;
    options.largest_message = static_cast<std::size_t>(profile_.largest_answer) << 20;
    PROBE_ASSIGN(channel_, wire::GrpcChannel::connect(server_, options));
    return reset(deadlines.connect);
  }
  void close() override { channel_.reset(); }

  // It drops what was sent and not asked for, as of an episode that was killed; a server that has
  // not heard it ignores the policy that it is told.
  Status begin_episode(const policy::EpisodeStart&, const Deadlines& deadlines) override {
    return reset(deadlines.answer);
  }
  Status end_episode(const policy::EpisodeEnd&, const Deadlines& deadlines) override {
    return reset(deadlines.answer);
  }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    lerobot::Observation observation;
    // A clock's time only gets into its log; this one is the same at each asking.
    observation.timestamp = request.step;
    observation.timestep = timestep_of(request);
    for (std::size_t i = 0; i < request.state.size(); ++i)
      observation.content.emplace_back(number_name(tag_, i), request.state[i]);
    for (const RequestImage& image : request.images)
      observation.content.emplace_back(picture_name(image.key), image.pixels);
    observation.content.emplace_back(std::string(kInstruction), request.prompt);
    PROBE_TRY(check_distinct_keys(observation.content));
    const wire::GrpcCall sent = lerobot::send_observation(observation);

    // All but its last part while the server may still work for another world.
    if (!channel_) return bad("there is no connection");
    std::unique_lock next(shared_->next_turn());
    const auto begun = channel_->begin(sent, 2 * deadlines.answer);
    std::unique_lock turn(shared_->turn(), std::try_to_lock);
    const bool is_busy = !turn.owns_lock();
    if (is_busy) turn.lock();
    next.unlock();
    PROBE_TRY(load(request, deadlines));
    generation_ = shared_->generation();
    // A server that others keep busy is asked at once and waits for the observation by itself,
    // which spares it a way there and back. Nobody else's question is there in this turn.
    std::shared_ptr<wire::GrpcChannel::Begun> asked;
    if (is_busy) asked = channel_->start(lerobot::get_actions(), deadlines.answer);
    if (auto arrived = heard(channel_->end(begun)); !arrived) return arrived.failure();
    auto message = asked ? heard(channel_->end(asked)) : Result<wire::Bytes>(wire::Bytes());
    // It waited for less time than the observation took, or not at all.
    if (message && message->empty()) message = called(lerobot::get_actions(), deadlines.answer);
    turn.unlock();
    if (!message) return message.failure();
    auto actions = lerobot::actions_of(*message, kMostActionBytes);
    if (!actions) return actions.failure();
    if (actions->empty()) {
      // As also of one that was started anew and has no policy.
      shared_->forget(generation_);
      return bad(
          "the server answered without actions: its policy failed, another one was loaded "
          "meanwhile, or it got no observation; its log says why");
    }
    return in_time(*actions, observation.timestep);
  }

 private:
  // Not while an observation is on its way, which it would drop.
  Status reset(wire::Duration timeout) {
    const std::lock_guard next(shared_->next_turn());
    const std::lock_guard turn(shared_->turn());
    return call(lerobot::ready(), timeout);
  }

  // The policy, which is told what observations hold: at the first of them.
  Status load(const Request& request, const Deadlines& deadlines) {
    return shared_->load_once([&]() -> Status {
      setup_.features = features_of(request, tag_);
      // Not called(): there is no loading to forget yet, and who loads holds what forgets.
      auto loaded = channel_->call(lerobot::send_policy(setup_), deadlines.answer);
      if (loaded) return {};
      Failure failure = loaded.failure();
      failure.message = "loading `" + setup_.model + "`: " + failure.message;
      return failure;
    });
  }

  Result<wire::Bytes> called(const wire::GrpcCall& asked, wire::Duration timeout) {
    if (!channel_) return bad("there is no connection");
    return heard(channel_->call(asked, timeout));
  }
  Result<wire::Bytes> heard(Result<wire::Bytes> answer) {
    // Whoever answers next may have been started since.
    if (!answer && channel_->is_lost()) shared_->forget(shared_->generation());
    return answer;
  }
  Status call(const wire::GrpcCall& asked, wire::Duration timeout) {
    const auto answer = called(asked, timeout);
    return answer ? Status() : Status(answer.failure());
  }

  // Actions one control step after the other, from the one that was asked for.
  static Result<std::vector<RawAction>> in_time(const std::vector<lerobot::TimedAction>& actions,
                                                std::int64_t timestep) {
    std::vector<RawAction> raw;
    for (const lerobot::TimedAction& timed : actions) {
      const auto wanted = timestep + static_cast<std::int64_t>(raw.size());
      if (timed.timestep != wanted) {
        return bad("an answer to another observation: expected timestep " + std::to_string(wanted) +
                   ", got " + std::to_string(timed.timestep) +
                   "; does somebody else ask this server?");
      }
      PROBE_ASSIGN(const std::vector<RawAction> one, to_actions(timed.action));
      if (one.size() != 1)
        return bad("expected one action a timestep, got " + std::to_string(one.size()));
      raw.push_back(one.front());
    }
    return raw;
  }

  Profile profile_;
  wire::Endpoint server_;
  lerobot::PolicySetup setup_;
  std::string tag_;  // of the setup, in the names of an observation's numbers
  std::shared_ptr<SharedModel> shared_ = std::make_shared<SharedModel>();
  std::unique_ptr<wire::GrpcChannel> channel_;
  std::uint64_t generation_ = 0;
};

Failure misfit(std::string message) { return {Fault::kUsage, std::move(message), "--policy"}; }

Result<std::unique_ptr<Transport>> make_lerobot(const Profile& profile,
                                                const wire::Endpoint& server) {
  for (const char* option : {"type", "model"}) {
    const auto found = server.options.find(option);
    if (found != server.options.end() && !found->second.empty()) continue;
    return misfit(
        "a LeRobot server begins without a policy: write "
        "`lerobot://HOST:PORT?type=TYPE&model=PATH`, TYPE as `smolvla`, PATH as the server sees "
        "it");
  }
  for (const ImageRule& image : profile.images) {
    if (!image.key.starts_with(kPicturePrefix) || image.key.size() == kPicturePrefix.size() ||
        image.layout != PixelLayout::kHwcU8) {
      return misfit("a LeRobot server's pictures are named `" + std::string(kPicturePrefix) +
                    "NAME` and are hwc_u8, not `" + image.key + "`");
    }
  }
  if (profile.state_layout == StateLayout::kNone || profile.state_key != kStateFeature ||
      !profile.more_states.empty()) {
    return misfit("a LeRobot server reads one state, with `state.key` = " +
                  std::string(kStateFeature) + ": say its `state.layout`");
  }
  if (profile.prompt_key != kInstruction)
    return misfit("a LeRobot server reads its instruction under `prompt.key` = " +
                  std::string(kInstruction));
  return std::unique_ptr<Transport>(std::make_unique<LeRobot>(profile, server));
}

constexpr std::array<std::string_view, 3> kLeRobotOptions = {"type", "model", "device"};

}  // namespace

constinit const ProtocolRow lerobot_row{
    .word = "lerobot",
    .argument = "//HOST:PORT?type=TYPE&model=PATH",
    .meaning = "a LeRobot policy server",
    .port = "8080",
    .options = kLeRobotOptions,
    .fixed_keys = {},
    .key_uses = plain_key_uses,
    .make = make_lerobot,
    .serve = serve_lerobot,
    // As rendered: an episode is known by its first picture.
    .served_options = "&chunk.length=any&chunk.use=all&type=served&model=/served",
    .has_one_place = true,
    .carrier = Carrier::kGrpc,
    .has_reset = always_has_reset,
};

}  // namespace probe::servers
