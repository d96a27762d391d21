// All that the rest of the program must know of a protocol: one row each, in the protocol's own
// file of protocols/. protocols/protocols.def lists them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/listener.h"

namespace probe::servers {

struct ServeOptions;

// A key in one map of a request, and what of the profile stands under it.
struct KeyUse {
  std::string map;  // empty: the outermost
  std::string key;
  std::string field;  // of the profile, as in Mistake; empty: the protocol's own
  std::string shown;  // what messages call it
};

// What carries a protocol's messages.
enum class Carrier : std::uint8_t { kWebSocket, kHttp, kZmq, kGrpc };

using Listen = Result<std::unique_ptr<wire::Listener>> (*)(const std::string& address,
                                                           const std::string& port,
                                                           wire::MakeSpeaker make);
Listen listen_over(Carrier carrier);

// How a protocol's servers take the questions of several worlds at once.
enum class Batches : std::uint8_t {
  kNone,
  kOneMessage,  // in one message, by Transport::ask_all; they keep nothing between questions
  kGathered,    // each by its own connection; the server is told how many to wait for
};

// What a URL begins with where it names no protocol, as one that was copied: `wss://HOST/PATH`.
struct Scheme {
  std::string_view word;
  Carrier carrier;
  bool is_tls;
  std::string_view port;  // where the address has none
  std::string_view meaning;
};
std::span<const Scheme> url_schemes();

struct ProtocolRow {
  std::string_view word;      // before "://", and `protocol` of a profile
  std::string_view argument;  // what follows the colon of --policy, for people
  std::string_view meaning;   // for people: "an openpi server"
  std::string_view port;      // where its servers usually listen
  // What an address may say besides a profile's fields.
  std::span<const std::string_view> options;
  // In the outermost map of a request: the protocol's own, and those that its servers look for; a
  // picture under such a key would be taken for something else.
  std::span<const std::string_view> fixed_keys;
  // What of a profile is sent under which key; the order and form of a request are make's.
  std::vector<KeyUse> (*key_uses)(const Profile& profile);
  // Fails (kUsage) on an option's or a field's value that the protocol does not know.
  Result<std::unique_ptr<Transport>> (*make)(const Profile& profile, const wire::Endpoint& server);
  // Its server's side, see served.h.
  Result<std::unique_ptr<wire::Listener>> (*serve)(const ServeOptions& options);
  // Values of a profile's `dialect`; the first is that of a profile that says none.
  std::span<const std::string_view> dialects = {};
  // What of a profile reads our own server as it is meant, beside what all of them need.
  std::string_view served_options;
  // Its servers know no connection from another: those that keep something of an episode keep one.
  bool has_one_place = false;
  Carrier carrier = Carrier::kWebSocket;
  // Of questions over HTTP where the address has none.
  std::string_view path = "/";
  // Whether the protocol has a word for an episode's beginning; null: it has none.
  bool (*has_reset)(std::string_view dialect) = nullptr;
  // Whether its servers may answer with the arm's joints.
  bool has_joint_actions = false;
  // Two questions of the same content differ, as they carry the time.
  bool is_timed = false;
  // Another policy can take the place of one that answers without a connection being lost: who
  // answers is asked again now and then, see Identity::is_due().
  bool is_exchanged_unseen = false;
  // Where they gather, Transport::gather() says how many.
  Batches batches = Batches::kNone;
};

inline bool always_has_reset(std::string_view) { return true; }

// The address's path, or the protocol's where it says none.
inline std::string path_of(const ProtocolRow& row, const wire::Endpoint& server) {
  return server.path == "/" ? std::string(row.path) : server.path;
}

const ProtocolRow& row_of(Protocol protocol);

// Fails (kUsage, where = `where`) on a word that is none of the protocol's dialects; an empty one
// is fine.
Status check_dialect(Protocol protocol, std::string_view dialect, std::string_view where);

// The uses of most protocols, for key_uses: a key for each picture, for the state where there is
// one, and for the instruction, all in the outermost map.
std::vector<KeyUse> plain_key_uses(const Profile& profile);
std::vector<KeyUse> image_key_uses(const Profile& profile);
KeyUse prompt_key_use(const Profile& profile);
KeyUse state_key_use(const std::string& key);

#define PROBE_PROTOCOL(name, row) extern const ProtocolRow row;
#include "runtime/servers/protocols/protocols.def"
#undef PROBE_PROTOCOL

}  // namespace probe::servers
