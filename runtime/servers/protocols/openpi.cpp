// openpi's protocol (src/openpi/serving/websocket_policy_server.py): {image keys, state key, prompt
// key} -> {"actions"}. Sends the API key, if there is one. Servers keep nothing between requests,
// so episodes are not announced.
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

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::Map map;
    append_images(request, &map);
    if (!request.state.empty()) {
      map.emplace_back(profile_.state_key, state_array(profile_, request.state));
    }
    for (const auto& [key, state] : request.more_states)
      map.emplace_back(key, state_array(profile_, state));
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
};

}  // namespace probe::servers
