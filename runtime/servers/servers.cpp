#include "runtime/servers/servers.h"

#include "runtime/base/spelling.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/server_policy.h"

namespace probe::servers {
namespace {

Failure usage(std::string message) { return {Fault::kUsage, std::move(message), "--policy"}; }

}  // namespace

Result<ServerChoice> choose_server(Protocol protocol, std::string_view argument) {
  const ProtocolRow& row = row_of(protocol);
  const std::string name(row.word);
  PROBE_ASSIGN(wire::Endpoint server, wire::parse_endpoint(argument, row.port));
  std::map<std::string, std::string> options = std::move(server.options);
  server.options.clear();

  const auto chosen = options.find("profile");
  PROBE_ASSIGN(Profile profile, find_profile(chosen == options.end() ? name : chosen->second));
  if (profile.protocol != protocol) {
    const std::string wanted(to_word(profile.protocol));
    return usage("profile `" + profile.name + "` is for servers that speak " + wanted +
                 ": write `" + wanted + "://...`, not `" + name + "://...`");
  }
  if (chosen != options.end()) options.erase(chosen);
  std::vector<std::string> own(row.options.begin(), row.options.end());
  for (const std::string& option : own) {
    if (auto node = options.extract(option); !node.empty()) server.options.insert(std::move(node));
  }
  // An image option stands for all of the file's: it could not name the one it replaces.
  if (options.contains("image")) profile.images.clear();
  for (const auto& [field, value] : options) {
    if (field == "protocol") return usage("`protocol` is what stands before `://`");
    if (auto set = set_field(profile, field, value); !set) {
      own.emplace_back("profile");
      return usage(set.failure().message + did_you_mean(field, own));
    }
  }
  if (auto whole = check_profile(profile); !whole) return usage(whole.failure().message);
  return ServerChoice{std::move(profile), std::move(server)};
}

std::string describe(const ServerChoice& choice) {
  std::string text = std::string(to_word(choice.profile.protocol)) + " profile " +
                     choice.profile.name + " sha256 " + profile_sha256(choice.profile);
  for (const auto& [name, value] : choice.server.options) text += " " + name + " " + value;
  return text;
}

Result<std::unique_ptr<Transport>> make_transport(const ServerChoice& choice,
                                                  std::shared_ptr<SharedModel> model) {
  PROBE_TRY(check_api_key());
  PROBE_TRY(check_dialect(choice.profile.protocol, choice.profile.dialect, "--policy"));
  auto transport = row_of(choice.profile.protocol).make(choice.profile, choice.server);
  if (transport && model) (*transport)->share(std::move(model));
  return transport;
}

Result<std::unique_ptr<policy::Policy>> make_server(
    Protocol protocol, std::string_view argument, policy::QueryMeter* queries,
    std::shared_ptr<SharedModel> model,
    const std::vector<std::pair<std::string, std::string>>& measured) {
  PROBE_ASSIGN(ServerChoice choice, choose_server(protocol, argument));
  for (const auto& [field, value] : measured) PROBE_TRY(set_field(choice.profile, field, value));
  PROBE_ASSIGN(std::unique_ptr<Transport> transport, make_transport(choice, std::move(model)));
  return std::unique_ptr<policy::Policy>(std::make_unique<ServerPolicy>(
      std::move(choice.profile), choice.server.name(), std::move(transport), queries));
}

}  // namespace probe::servers
