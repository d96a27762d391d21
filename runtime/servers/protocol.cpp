// The table of protocols.
#include "runtime/servers/protocol.h"

#include <algorithm>
#include <array>

namespace probe::servers {
namespace {

constexpr Protocol kAll[] = {
#define PROBE_PROTOCOL(name, row) Protocol::name,
#include "runtime/servers/protocols/protocols.def"
#undef PROBE_PROTOCOL
};

constexpr Scheme kSchemes[] = {
    {"wss", Carrier::kWebSocket, true, "443", "a server over WebSocket and TLS"},
    {"ws", Carrier::kWebSocket, false, "80", "a server over WebSocket"},
    {"https", Carrier::kHttp, true, "443", "a server over HTTP and TLS"},
    {"http", Carrier::kHttp, false, "80", "a server over HTTP"},
};

}  // namespace

Listen listen_over(Carrier carrier) {
  switch (carrier) {
    case Carrier::kHttp:
      return [](const std::string& address, const std::string& port, wire::MakeSpeaker make) {
        return wire::listen_http(address, port, std::move(make));
      };
    case Carrier::kZmq:
      return wire::listen_zmq;
    case Carrier::kGrpc:
      return wire::listen_grpc;
    case Carrier::kWebSocket:
      break;
  }
  return [](const std::string& address, const std::string& port, wire::MakeSpeaker make) {
    return wire::listen_websocket(address, port, std::move(make));
  };
}

std::span<const Scheme> url_schemes() { return kSchemes; }

const ProtocolRow& row_of(Protocol protocol) {
  static constexpr const ProtocolRow* kRows[] = {
#define PROBE_PROTOCOL(name, row) &row,
#include "runtime/servers/protocols/protocols.def"
#undef PROBE_PROTOCOL
  };
  return *kRows[static_cast<std::size_t>(protocol)];
}

std::span<const Protocol> all_protocols() { return kAll; }

std::string_view to_word(Protocol protocol) { return row_of(protocol).word; }

Status check_dialect(Protocol protocol, std::string_view dialect, std::string_view where) {
  const ProtocolRow& row = row_of(protocol);
  const auto& known = row.dialects;
  if (dialect.empty() || std::find(known.begin(), known.end(), dialect) != known.end()) return {};
  std::string words;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (i > 0) words += i + 1 < known.size() ? ", " : " or ";
    words += known[i];
  }
  const std::string whose = "`dialect` of " + std::string(row.meaning);
  return Failure{Fault::kUsage,
                 (known.empty() ? "there is no " + whose + ", so it cannot be `"
                                : "the " + whose + " is " + words + ", not `") +
                     std::string(dialect) + "`",
                 std::string(where)};
}

std::vector<KeyUse> image_key_uses(const Profile& profile) {
  std::vector<KeyUse> uses;
  for (std::size_t i = 0; i < profile.images.size(); ++i) {
    const ImageRule& image = profile.images[i];
    uses.push_back(
        {"", image.key, "image " + std::to_string(i + 1),
         "`image` (" + (image.camera.empty() ? "first" : image.camera) + " -> " + image.key + ")"});
  }
  return uses;
}

KeyUse state_key_use(const std::string& key) { return {"", key, "state.key", "`state.key`"}; }

KeyUse prompt_key_use(const Profile& profile) {
  return {"", profile.prompt_key, "prompt.key", "`prompt.key`"};
}

std::vector<KeyUse> plain_key_uses(const Profile& profile) {
  std::vector<KeyUse> uses = image_key_uses(profile);
  if (profile.state_layout != StateLayout::kNone) uses.push_back(state_key_use(profile.state_key));
  for (std::size_t i = 0; i < profile.more_states.size(); ++i) {
    const std::string& key = profile.more_states[i].key;
    uses.push_back({"", key, "state.more " + std::to_string(i + 1), "`state.more` (" + key + ")"});
  }
  uses.push_back(prompt_key_use(profile));
  return uses;
}

}  // namespace probe::servers
