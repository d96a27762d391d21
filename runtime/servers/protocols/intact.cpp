// INT-ACT's dialect of openpi's protocol (policy_server_client): {"new_model_path"} once a
// run, {"reset"} before and after each episode, the state inside {"agent": {"eef_pos"}}.
#include <array>

#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/openpi_connection.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/servers/shared_model.h"

namespace probe::servers {
namespace {

class Intact : public Transport {
 public:
  Intact(const Profile& profile, const wire::Endpoint& server, std::string model)
      : profile_(profile), connection_(server), model_(std::move(model)) {}

  void share(std::shared_ptr<SharedModel> shared) override { shared_ = std::move(shared); }

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(metadata_, connection_.open(profile_, deadlines));
    if (was_open_) PROBE_TRY(see_model(deadlines));
    // Loading a model takes as long as a first answer.
    PROBE_TRY(shared_->load_once(
        [&] {
          return expect_status({{"new_model_path", model_}}, "model switched", deadlines);
        },
        "; it answers no more until it is restarted, whatever it says then"));
    was_open_ = true;
    return {};
  }
  void close() override { connection_.close(); }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    // In the course of an episode, too, another instruction reaches Octo by a reset alone.
    if (said_ && *said_ != request.prompt) PROBE_TRY(reset(deadlines));
    said_ = request.prompt;
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

  // Its wrappers keep the instruction (Octo's until a reset), pictures and chunks. Whoever was
  // killed or cut off in an episode has not said that it ended.
  Status begin_episode(const policy::EpisodeStart&, const Deadlines& deadlines) override {
    said_.reset();
    return reset(deadlines);
  }
  Status end_episode(const policy::EpisodeEnd&, const Deadlines& deadlines) override {
    said_.reset();
    return reset(deadlines);
  }

  std::vector<std::string> notes() const override {
    if (profile_.checkpoint == CheckpointUse::kNamed) return {};
    return {"the server does not load `model` = " + model_ +
            " but what its own configuration names (profile field `checkpoint`)"};
  }
  std::vector<std::string> remarks() const override { return metadata_remarks(metadata_); }

 private:
  // After a connection was lost: a server that was restarted has no model and refuses a reset,
  // whereupon it closes.
  Status see_model(const Deadlines& deadlines) {
    const std::uint64_t generation = shared_->generation();
    const Status there = reset(deadlines);
    if (there || there.failure().code != Fault::kAnswered) return there;
    shared_->forget(generation);
    PROBE_ASSIGN(metadata_, connection_.open(profile_, deadlines));
    return {};
  }

  Status reset(const Deadlines& deadlines) {
    return expect_status({{"reset", true}}, "reset", deadlines);
  }

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
  std::shared_ptr<SharedModel> shared_ = std::make_shared<SharedModel>();
  wire::Value metadata_;
  std::optional<std::string> said_;  // of this episode's last question
  bool was_open_ = false;
};

// Its servers begin without a model, so the address must name one.
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

constexpr std::array<std::string_view, 1> kIntactOptions = {"model"};
constexpr std::array<std::string_view, 2> kIntactKeys = {"new_model_path", "reset"};

}  // namespace

constinit const ProtocolRow intact_row{
    .word = "intact",
    .argument = "//HOST:PORT?model=PATH",
    .meaning = "an INT-ACT server",
    .port = "8000",
    .options = kIntactOptions,
    .fixed_keys = kIntactKeys,
    .key_uses = plain_key_uses,
    .make = make_intact,
    .serve = serve_intact,
    .served_options = "&chunk.length=any&chunk.use=all&worlds=many&model=/served",
    .has_reset = always_has_reset,
    .is_exchanged_unseen = true,  // any client may have another model loaded for all
};

}  // namespace probe::servers
