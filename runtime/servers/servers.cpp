#include "runtime/servers/servers.h"

#include <cstdlib>

#include "runtime/base/spelling.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/protocols/gr00t.h"
#include "runtime/servers/protocols/openpi.h"
#include "runtime/servers/protocols/openvla.h"
#include "runtime/servers/protocols/vlaeval.h"
#include "runtime/servers/server_policy.h"

namespace probe::servers {
namespace {

struct Entry {
  Protocol protocol;
  std::string_view port;                      // where its servers usually listen
  std::vector<std::string> (*own_options)();  // besides a profile's
};

std::vector<std::string> no_options() { return {}; }
std::vector<std::string> intact_options() { return {"model"}; }
std::vector<std::string> vlaeval_options() { return {"pictures", "send_state"}; }

constexpr Entry kEntries[] = {
    {Protocol::kOpenpi, "8000", no_options},    {Protocol::kIntact, "8000", intact_options},
    {Protocol::kRoboArena, "8000", no_options}, {Protocol::kVlaEval, "8000", vlaeval_options},
    {Protocol::kGr00t, "5555", no_options},     {Protocol::kOpenVla, "8000", no_options},
};

const Entry& entry_of(Protocol protocol) {
  for (const Entry& entry : kEntries) {
    if (entry.protocol == protocol) return entry;
  }
  return kEntries[0];
}

Failure usage(std::string message) { return {Fault::kUsage, std::move(message), "--policy"}; }

}  // namespace

Result<ServerChoice> choose_server(Protocol protocol, std::string_view argument) {
  const Entry& entry = entry_of(protocol);
  const std::string name(to_word(protocol));
  PROBE_ASSIGN(wire::Endpoint server, wire::parse_endpoint(argument, entry.port));
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
  for (const std::string& own : entry.own_options()) {
    if (auto node = options.extract(own); !node.empty()) server.options.insert(std::move(node));
  }
  // An image option stands for all of the file's: it could not name the one it replaces.
  if (options.contains("image")) profile.images.clear();
  for (const auto& [field, value] : options) {
    if (field == "protocol") return usage("`protocol` is what stands before `://`");
    if (auto set = set_field(profile, field, value); !set) {
      std::vector<std::string> own = entry.own_options();
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

Result<std::unique_ptr<Transport>> make_transport(const ServerChoice& choice) {
  switch (choice.profile.protocol) {
    case Protocol::kOpenpi:
      return make_openpi(choice.profile, choice.server);
    case Protocol::kIntact:
      return make_intact(choice.profile, choice.server);
    case Protocol::kRoboArena:
      return make_roboarena(choice.profile, choice.server);
    case Protocol::kVlaEval:
      return make_vlaeval(choice.profile, choice.server);
    case Protocol::kGr00t:
      return make_gr00t(choice.profile, choice.server);
    case Protocol::kOpenVla:
      return make_openvla(choice.profile, choice.server);
  }
  return usage("a protocol that nothing here speaks");
}

Result<std::unique_ptr<policy::Policy>> make_server(Protocol protocol, std::string_view argument,
                                                    policy::QueryMeter* queries) {
  PROBE_ASSIGN(ServerChoice choice, choose_server(protocol, argument));
  PROBE_ASSIGN(std::unique_ptr<Transport> transport, make_transport(choice));
  return std::unique_ptr<policy::Policy>(std::make_unique<ServerPolicy>(
      std::move(choice.profile), choice.server.name(), std::move(transport), queries));
}

std::string api_key() {
  const char* key = std::getenv("VLAPROBE_API_KEY");
  return key == nullptr ? "" : key;
}

}  // namespace probe::servers
