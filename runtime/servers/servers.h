// Policies that are servers: from //HOST:PORT?profile=NAME to a ServerPolicy.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"
#include "runtime/policy/query_meter.h"
#include "runtime/servers/batch.h"
#include "runtime/servers/identity.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/shared_model.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/endpoint.h"

namespace probe::servers {

// Where a server is and how it is spoken to. `server.options` are those of the protocol alone
// (intact's `model`); the profile has taken the others.
struct ServerChoice {
  Profile profile;
  wire::Endpoint server;
  // Questions that go in one message at most, and how long the first of them waits for others. No
  // answer depends on it: runs with other batches are one run.
  BatchLimits batch{.most = 1};
  // The server has one seed's episodes, as our own of a policy that draws: others are not its.
  std::optional<int> only_seed = {};
  std::vector<std::string> files = {};  // that it names: the profile's, and the authorities'
};

// `argument` is what stands after "openpi:". Options are `profile` (default: the protocol's own),
// any field of a profile, which then stands for the file's, `batch` and `batch_wait_ms` of
// protocols that have batches, `seed` of a server that has no other, and those of the protocol.
// Fails (kUsage) on others, with the nearest, and on a profile of another protocol.
Result<ServerChoice> choose_server(Protocol protocol, std::string_view argument);

// The same of a URL as it was copied, "wss://HOST/PATH?profile=NAME": what is spoken there the
// option `protocol` says, or the profile. Over TLS the option `ca` names the file of the
// authorities that are trusted in place of the system's.
Result<ServerChoice> choose_server(const Scheme& scheme, std::string_view argument);

// Whether its worlds' questions go in one message.
bool asks_together(const ServerChoice& choice);

// Without the address: what does the same at another address has the same.
std::string describe(const ServerChoice& choice);

// `model` is what all connections of a run have in common, or nothing. Asks one question a message.
Result<std::unique_ptr<Transport>> make_transport(const ServerChoice& choice,
                                                  std::shared_ptr<SharedModel> model = nullptr);

// `line` is where the worlds of a run meet for batches, or nothing: then this one is alone.
// `measured` are fields with values that profile and server leave open, see policy::Reading.
// `identity` is whom the run began with, or nothing: then nobody looks.
Result<std::unique_ptr<policy::Policy>> make_server(
    ServerChoice choice, policy::QueryMeter* queries, std::shared_ptr<SharedModel> model = nullptr,
    const std::vector<std::pair<std::string, std::string>>& measured = {},
    std::shared_ptr<SharedLine> line = nullptr, std::shared_ptr<Identity> identity = nullptr);

}  // namespace probe::servers
