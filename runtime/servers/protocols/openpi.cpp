// openpi's protocol (src/openpi/serving/websocket_policy_server.py): {image keys, state key, prompt
// key} -> {"actions"}. Sends the API key, if there is one. Servers keep nothing between requests,
// so episodes are not announced. Forks that take batches (openpi's pull request 941) are asked
// {"batch": [observation, ...]} and answer {"batch": [{"actions"}, ...]}, or the list alone.
#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/openpi_connection.h"
#include "runtime/servers/protocols/served_sides.h"

namespace probe::servers {
namespace {

class Openpi : public Transport {
 public:
  Openpi(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), connection_(server) {}

  Status open(const Deadlines& deadlines) override {
    PROBE_ASSIGN(metadata_, connection_.open(profile_, deadlines));
    return {};
  }
  void close() override { connection_.close(); }
  Status listen(wire::Duration wait) override { return connection_.listen(wait); }

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    PROBE_ASSIGN(const wire::Value answer, connection_.ask(observation(request), deadlines.answer));
    return actions_of(answer, request.action_size);
  }

  Result<BatchAnswers> ask_all(std::span<const Request* const> requests,
                               const Deadlines& deadlines) override {
    wire::List items;
    for (const Request* request : requests) {
      items.emplace_back(observation(*request));
      PROBE_TRY(check_distinct_keys(items.back()));
    }
    PROBE_ASSIGN(const wire::Value answer,
                 connection_.ask(wire::Map{{"batch", std::move(items)}}, deadlines.answer));
    PROBE_TRY(check_error(answer));
    const wire::Value* batch = answer.find("batch");
    const auto* answers = (batch == nullptr ? answer : *batch).as<wire::List>();
    if (answers == nullptr) {
      return bad("expected a map with `batch`, a list of " + std::to_string(requests.size()) +
                 " answers; got " + wire::describe(batch == nullptr ? answer : *batch));
    }
    PROBE_TRY(check_batch(answers->size(), requests.size()));
    BatchAnswers all;
    for (std::size_t i = 0; i < answers->size(); ++i) {
      auto actions = actions_of((*answers)[i], requests[i]->action_size);
      if (!actions) actions = of_item(actions.failure(), i, answers->size());
      all.push_back(std::move(actions));
    }
    return all;
  }

  std::vector<std::string> remarks() const override { return metadata_remarks(metadata_); }

 private:
  wire::Map observation(const Request& request) const {
    wire::Map map;
    append_images(request, &map);
    if (!request.state.empty()) {
      map.emplace_back(profile_.state_key, state_array(profile_, request.state));
    }
    for (const auto& [key, state] : request.more_states)
      map.emplace_back(key, state_array(profile_, state));
    map.emplace_back(profile_.prompt_key, request.prompt);
    return map;
  }

  static Status check_error(const wire::Value& answer) {
    const wire::Value* error = answer.find("error");
    if (error == nullptr) return {};
    const auto* text = error->as<std::string>();
    return bad("the server failed: " +
               (text == nullptr ? wire::describe(*error) : last_lines(*text)));
  }
  static Result<std::vector<RawAction>> actions_of(const wire::Value& answer, std::size_t size) {
    PROBE_TRY(check_error(answer));
    const wire::Value* actions = answer.find("actions");
    if (actions == nullptr) {
      return bad("expected a map with `actions`, got " + wire::describe(answer));
    }
    return to_actions(*actions, size);
  }

  Profile profile_;
  OpenpiConnection connection_;
  wire::Value metadata_;
};

Result<std::unique_ptr<Transport>> make_openpi(const Profile& profile,
                                               const wire::Endpoint& server) {
  return std::unique_ptr<Transport>(std::make_unique<Openpi>(profile, server));
}

}  // namespace

constinit const ProtocolRow openpi_row{
    .word = "openpi",
    .argument = "//HOST:PORT?profile=NAME",
    .meaning = "an openpi server",
    .port = "8000",
    .options = {},
    .fixed_keys = {},
    .key_uses = plain_key_uses,
    .make = make_openpi,
    .serve = serve_openpi,
    .served_options = "&chunk.length=any&chunk.use=all",
    .has_joint_actions = true,
    .batches = Batches::kOneMessage,
};

}  // namespace probe::servers
