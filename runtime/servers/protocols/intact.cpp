// INT-ACT's dialect of openpi's protocol (policy_server_client): {"new_model_path"} on each
// connection, {"reset"} after each episode, the state inside {"agent": {"eef_pos"}}.
#include <array>

#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/openpi_connection.h"

namespace probe::servers {
namespace {

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
};

}  // namespace probe::servers
