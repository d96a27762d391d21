// openvla/openvla: vla-scripts/deploy.py. An exception there is the JSON text "error" with status
// 200.
#include "runtime/servers/protocols/openvla.h"

#include <array>

#include "runtime/servers/protocol.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/wire/http.h"
#include "runtime/wire/json.h"

namespace probe::servers {
namespace {

constexpr std::string_view kEncoded = "encoded";

class OpenVla : public Transport {
 public:
  OpenVla(const Profile& profile, const wire::Endpoint& server)
      : profile_(profile), server_(server), path_(path_of(openvla_row, server)) {}

  // There is nothing to be asked but actions: any answer at all is a server.
  Status open(const Deadlines& deadlines) override {
    const wire::HttpRequest any;
    auto answer = wire::http_exchange(server_, any, options(deadlines, deadlines.connect));
    return answer ? Status() : Status(answer.failure());
  }
  // Each exchange has a connection of its own.
  void close() override {}

  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines) override {
    wire::HttpRequest post;
    post.method = "POST";
    post.path = path_;
    PROBE_ASSIGN(post.body, openvla_request(profile_, request));
    PROBE_ASSIGN(const wire::HttpResponse answer,
                 wire::http_exchange(server_, post, options(deadlines, deadlines.answer)));
    if (answer.status != 200) {
      return bad("`POST " + path_ + "` is answered with status " + std::to_string(answer.status) +
                 wire::sent_elsewhere(static_cast<unsigned>(answer.status), answer.location) +
                 (answer.body.empty() ? "" : ": " + last_lines(answer.body)));
    }
    return openvla_actions(answer.body);
  }

 private:
  wire::HttpOptions options(const Deadlines& deadlines, wire::Duration timeout) const {
    return {deadlines.connect, timeout, static_cast<std::size_t>(profile_.largest_answer) << 20};
  }

  Profile profile_;
  wire::Endpoint server_;
  std::string path_;
};

}  // namespace

Result<std::string> openvla_request(const Profile& profile, const Request& request) {
  wire::Map map;
  for (const RequestImage& image : request.images) map.emplace_back(image.key, image.pixels);
  if (!request.state.empty()) {
    map.emplace_back(profile.state_key, state_array(profile, request.state));
  }
  map.emplace_back(profile.prompt_key, request.prompt);
  if (!profile.unnorm_key.empty()) map.emplace_back("unnorm_key", profile.unnorm_key);
  const wire::Value whole(std::move(map));
  PROBE_TRY(check_distinct_keys(whole));
  std::string plain = wire::to_json(whole);
  if (profile.dialect != kEncoded) return plain;
  return wire::to_json(wire::Map{{"encoded", std::move(plain)}});
}

Result<std::vector<RawAction>> openvla_actions(std::string_view body) {
  PROBE_ASSIGN(wire::Value answer, wire::from_json(body));
  if (const auto* text = answer.as<std::string>()) {
    if (*text == "error") {
      return bad(
          "the server failed and answers \"error\"; the reason is in its own log (often an "
          "`unnorm_key` it does not have)");
    }
    PROBE_ASSIGN(wire::Value inner, wire::from_json(*text));
    answer = std::move(inner);
  }
  return to_actions(answer);
}

namespace {

// The path is the server's, or /act.
Result<std::unique_ptr<Transport>> make_openvla(const Profile& profile,
                                                const wire::Endpoint& server) {
  return std::unique_ptr<Transport>(std::make_unique<OpenVla>(profile, server));
}

constexpr std::array<std::string_view, 2> kOpenVlaDialects = {"plain", kEncoded};
constexpr std::array<std::string_view, 2> kOpenVlaKeys = {"unnorm_key", "encoded"};

}  // namespace

constinit const ProtocolRow openvla_row{
    .word = "openvla",
    .argument = "//HOST:PORT",
    .meaning = "an OpenVLA server",
    .port = "8000",
    .options = {},
    .fixed_keys = kOpenVlaKeys,
    .key_uses = plain_key_uses,
    .make = make_openvla,
    .serve = serve_openvla,
    .dialects = kOpenVlaDialects,
    .served_options = "&chunk.length=any&chunk.use=all",
    .has_one_place = true,
    .carrier = Carrier::kHttp,
    .path = "/act",
    .is_exchanged_unseen = true,  // each question has a connection of its own
};

}  // namespace probe::servers
