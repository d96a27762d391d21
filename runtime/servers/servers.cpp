#include "runtime/servers/servers.h"

#include <charconv>

#include "runtime/base/spelling.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/server_policy.h"

namespace probe::servers {
namespace {

constexpr const char* kWaitMs = "batch_wait_ms";
constexpr int kLongestWaitMs = 60'000;

Failure usage(std::string message) { return {Fault::kUsage, std::move(message), "--policy"}; }

using Options = std::map<std::string, std::string>;

// Takes the option out; nothing: it is not there.
Result<std::optional<int>> take_number(Options& options, const std::string& name, int least,
                                       int most) {
  const auto node = options.extract(name);
  if (node.empty()) return std::optional<int>();
  const std::string& text = node.mapped();
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) {
    return usage("`" + name + "` is a whole number from " + std::to_string(least) + " to " +
                 std::to_string(most) + ", not `" + text + "`");
  }
  return std::optional(value);
}

Result<BatchLimits> take_limits(Options& options, const ProtocolRow& row) {
  BatchLimits limits{.most = 1};
  if (row.batches == Batches::kNone && (options.contains("batch") || options.contains(kWaitMs))) {
    std::string takers;
    for (const Protocol protocol : all_protocols()) {
      if (row_of(protocol).batches == Batches::kNone) continue;
      takers += (takers.empty() ? "" : ", ") + std::string(to_word(protocol));
    }
    return usage("servers that speak " + std::string(row.word) +
                 " take no batches; those do that speak " + takers);
  }
  if (options.contains(kWaitMs) && !options.contains("batch"))
    return usage(std::string("`") + kWaitMs + "` is how long a batch waits: it goes with `batch`");
  PROBE_ASSIGN(const auto most, take_number(options, "batch", 1, kMostInBatch));
  PROBE_ASSIGN(const auto wait, take_number(options, kWaitMs, 0, kLongestWaitMs));
  limits.most = most.value_or(limits.most);
  if (wait) limits.wait = wire::Duration(*wait);
  return limits;
}

Status check_fit_for_batches(const Profile& profile, const ProtocolRow& row) {
  // One connection would carry the questions of all worlds.
  if (row.batches == Batches::kOneMessage && profile.connection == ConnectionUse::kPerEpisode) {
    return usage("profile `" + profile.name +
                 "` has `connection = per_episode`: its server knows an episode by its "
                 "connection, and a batch has one for all worlds");
  }
  if (profile.worlds == WorldsAtOnce::kOne) {
    return usage("profile `" + profile.name +
                 "` has `worlds = one`: its server keeps something of an episode for all who ask "
                 "it, so worlds cannot share a batch");
  }
  return {};
}

Result<std::optional<int>> take_seed(Options& options) {
  const auto node = options.extract("seed");
  if (node.empty()) return std::optional<int>();
  const std::string& text = node.mapped();
  int seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size())
    return usage("`seed` is a whole number, found `" + text + "`");
  return std::optional<int>(seed);
}

// How the address should begin for another protocol's profile. `scheme` is a URL's, or null.
std::string address_for(const Profile& profile, const Scheme* scheme) {
  const std::string word(to_word(profile.protocol));
  if (scheme == nullptr) return "write `" + word + "://...`";
  const std::string hint = "`?protocol=` is left out beside `?profile=`";
  for (const Scheme& other : url_schemes()) {
    if (other.carrier != row_of(profile.protocol).carrier || other.is_tls != scheme->is_tls)
      continue;
    if (other.word == scheme->word) return hint;
    return "its URL begins with `" + std::string(other.word) + "://`, and " + hint;
  }
  return "write `" + word + "://HOST:PORT`, as it goes over no URL";
}

// Of a server where it is: the profile that the options name and what they change of it. `scheme`
// is a URL's, or null.
Result<ServerChoice> chosen(Protocol protocol, wire::Endpoint server,
                            const Scheme* scheme = nullptr) {
  const ProtocolRow& row = row_of(protocol);
  const std::string name(row.word);
  Options options = std::move(server.options);
  server.options.clear();

  const auto chosen = options.find("profile");
  PROBE_ASSIGN(Profile profile, find_profile(chosen == options.end() ? name : chosen->second));
  if (profile.protocol != protocol) {
    return usage("profile `" + profile.name + "` is for servers that speak " +
                 std::string(to_word(profile.protocol)) + ", not " + name + ": " +
                 address_for(profile, scheme));
  }
  std::vector<std::string> files;
  if (!server.tls.authorities.empty()) files.push_back(server.tls.authorities);
  if (chosen != options.end()) {
    if (names_file(chosen->second)) files.push_back(chosen->second);
    options.erase(chosen);
  }
  std::vector<std::string> own(row.options.begin(), row.options.end());
  for (const std::string& option : own) {
    if (auto node = options.extract(option); !node.empty()) server.options.insert(std::move(node));
  }
  PROBE_ASSIGN(const BatchLimits limits, take_limits(options, row));
  PROBE_ASSIGN(const std::optional<int> seed, take_seed(options));
  // An image option stands for all of the file's: it could not name the one it replaces.
  if (options.contains("image")) profile.images.clear();
  for (const auto& [field, value] : options) {
    if (field == "protocol")
      return usage("`protocol` is what stands before `://`; a URL (wss://, https://) has it once");
    if (field == "ca") return usage("`ca` is of servers over TLS: wss://... or https://...");
    if (auto set = set_field(profile, field, value); !set) {
      own.emplace_back("profile");
      return usage(set.failure().message + did_you_mean(field, own));
    }
  }
  if (auto whole = check_profile(profile); !whole) return usage(whole.failure().message);
  if (limits.most > 1) PROBE_TRY(check_fit_for_batches(profile, row));
  return ServerChoice{std::move(profile), std::move(server), limits, seed, std::move(files)};
}

// The protocols that go over what a URL begins with: "openpi, intact".
std::string words_over(Carrier carrier) {
  std::string words;
  for (const Protocol protocol : all_protocols()) {
    if (row_of(protocol).carrier != carrier) continue;
    words += (words.empty() ? "" : ", ") + std::string(to_word(protocol));
  }
  return words;
}

// An address's text without one of its options.
std::string without_option(std::string_view address, std::string_view name) {
  const std::size_t query = std::min(address.find('?'), address.size());
  std::string text(address.substr(0, query));
  char before = '?';
  for (std::string_view rest = address.substr(query); !rest.empty();) {
    rest.remove_prefix(1);
    const std::string_view option = rest.substr(0, rest.find('&'));
    rest.remove_prefix(option.size());
    if (option.substr(0, option.find('=')) == name) continue;
    (text += before) += option;
    before = '&';
  }
  return text;
}

// The same address, as it begins for a protocol that does not go over `scheme`'s URLs.
std::string address_of(Protocol protocol, const Scheme& scheme, const wire::Endpoint& server,
                       std::string_view argument) {
  const ProtocolRow& row = row_of(protocol);
  for (const Scheme& other : url_schemes()) {
    if (other.carrier == row.carrier && other.is_tls == scheme.is_tls)
      return std::string(other.word) + ":" + std::string(argument);
  }
  const std::string rest = without_option(argument, "protocol");
  const std::string name =
      server.host.find(':') == std::string::npos ? server.host : "[" + server.host + "]";
  const std::string_view port = server.port == scheme.port ? row.port : server.port;
  return std::string(row.word) + "://" + name + ":" + std::string(port) +
         rest.substr(std::min(rest.find('?'), rest.size()));
}

// Of a URL that says nothing of what is spoken there: that it can be what others are for.
std::string words_elsewhere(const Scheme& scheme, std::string_view argument) {
  std::string text;
  for (const Scheme& other : url_schemes()) {
    if (other.carrier == scheme.carrier || other.is_tls != scheme.is_tls) continue;
    const std::string place(argument.substr(0, argument.find('?')));
    text +=
        "; " + words_over(other.carrier) + " at `" + std::string(other.word) + ":" + place + "`";
  }
  return text;
}

// What is spoken at a URL, by its options; takes `protocol` from them. `argument` is the URL behind
// its colon.
Result<Protocol> spoken(const Scheme& scheme, wire::Endpoint& server, std::string_view argument) {
  Options& options = server.options;
  const std::string url = std::string(scheme.word) + "://";
  std::string word;
  if (auto node = options.extract("protocol"); !node.empty()) {
    word = node.mapped();
  } else if (const auto profile = options.find("profile"); profile != options.end()) {
    PROBE_ASSIGN(const Profile found, find_profile(profile->second));
    word = to_word(found.protocol);
  } else {
    return usage("`" + url + "` does not say what is spoken there: add ?profile=NAME, or " +
                 "?protocol=NAME of " + words_over(scheme.carrier) +
                 words_elsewhere(scheme, argument));
  }
  for (const Protocol protocol : all_protocols()) {
    if (to_word(protocol) != word) continue;
    if (row_of(protocol).carrier == scheme.carrier) return protocol;
    return usage("`" + word + "` is not spoken over `" + url + "`: write `" +
                 address_of(protocol, scheme, server, argument) + "`");
  }
  return usage("`" + word + "` is not spoken over `" + url + "`; " + words_over(scheme.carrier) +
               (words_over(scheme.carrier).find(',') == std::string::npos ? " is" : " are"));
}

}  // namespace

Result<ServerChoice> choose_server(Protocol protocol, std::string_view argument) {
  PROBE_ASSIGN(wire::Endpoint server, wire::parse_endpoint(argument, row_of(protocol).port));
  return chosen(protocol, std::move(server));
}

Result<ServerChoice> choose_server(const Scheme& scheme, std::string_view argument) {
  PROBE_ASSIGN(wire::Endpoint server, wire::parse_endpoint(argument, scheme.port));
  PROBE_ASSIGN(const Protocol protocol, spoken(scheme, server, argument));
  if (scheme.is_tls) {
    server.tls.is_on = true;
    if (auto node = server.options.extract("ca"); !node.empty())
      server.tls.authorities = node.mapped();
  }
  return chosen(protocol, std::move(server), &scheme);
}

bool asks_together(const ServerChoice& choice) {
  return choice.batch.most > 1 && row_of(choice.profile.protocol).batches == Batches::kOneMessage;
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
  const ProtocolRow& row = row_of(choice.profile.protocol);
  auto transport = row.make(choice.profile, choice.server);
  if (transport && row.batches == Batches::kGathered) (*transport)->gather(choice.batch);
  if (transport && model) (*transport)->share(std::move(model));
  return transport;
}

Result<std::unique_ptr<policy::Policy>> make_server(
    ServerChoice choice, policy::QueryMeter* queries, std::shared_ptr<SharedModel> model,
    const std::vector<std::pair<std::string, std::string>>& measured,
    std::shared_ptr<SharedLine> line, std::shared_ptr<Identity> identity) {
  for (const auto& [field, value] : measured) PROBE_TRY(set_field(choice.profile, field, value));
  std::unique_ptr<Transport> transport;
  if (asks_together(choice)) {
    if (!line) line = std::make_shared<SharedLine>();
    const auto make = [&]() -> Result<std::shared_ptr<BatchLine>> {
      PROBE_ASSIGN(auto own, make_transport(choice, std::move(model)));
      return std::make_shared<BatchLine>(std::move(own), choice.batch, queries, identity,
                                         choice.profile);
    };
    PROBE_ASSIGN(auto shared, line->get(make));
    transport = make_batched(std::move(shared));
    queries = nullptr;   // the line counts them as they go over the wire
    identity = nullptr;  // and asks who answers
  } else {
    PROBE_ASSIGN(transport, make_transport(choice, std::move(model)));
  }
  return std::unique_ptr<policy::Policy>(
      std::make_unique<ServerPolicy>(std::move(choice.profile), choice.server.name(),
                                     std::move(transport), queries, std::move(identity)));
}

}  // namespace probe::servers
