// The table of policies and the reading of their names.
#include "runtime/run/policies.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/base/spelling.h"
#include "runtime/expert/expert.h"
#include "runtime/policy/scripted.h"
#include "runtime/policy/weak.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/servers.h"

namespace probe::run {
namespace {

enum class Kind {
  kExpert,
  kNull,
  kRandom,
  kReach,
  kWrong,
  kNoisy,
  kPushed,
  kWeak,
  kReplay,
  kServer
};

struct Entry {
  std::string_view name;      // what stands before ':'
  std::string_view argument;  // what must follow it, for people; empty: nothing may
  Kind kind;
  PolicyTraits traits;
  std::string_view meaning;
  std::optional<servers::Protocol> protocol = {};  // of a server
  const servers::Scheme* scheme = nullptr;         // of a server without a protocol's word
};

const std::array kOwnPolicies = {
    Entry{"expert", "", Kind::kExpert, {}, "the scripted expert, which sees the world's state"},
    Entry{"null", "", Kind::kNull, {}, "stays where it is, gripper open"},
    Entry{"random", "", Kind::kRandom, {true, false, false}, "uniform actions"},
    Entry{"reach", "", Kind::kReach, {}, "goes to the source and never closes"},
    Entry{"wrong",
          "",
          Kind::kWrong,
          {false, false, true},
          "takes the first distractor, a thing or a part, or stays still"},
    Entry{"noisy",
          "SIGMA",
          Kind::kNoisy,
          {true, false, false},
          "the expert with noise, SIGMA in metres"},
    Entry{"pushed",
          "SIGMA",
          Kind::kPushed,
          {true, false, false},
          "the expert, pushed off its way in one step of eight"},
    Entry{"weak",
          "SPOT",
          Kind::kWeak,
          {true, false, false},
          "the expert, still where SPOT holds: ambient<0.12, camera>=3cm, clutter>=2+reworded"},
    Entry{
        "replay", "DIR", Kind::kReplay, {true, true, false}, "the recorded actions of another run"},
};

// Those of this process, then a server of each protocol, then any by its URL.
const std::vector<Entry>& all_policies() {
  static const std::vector<Entry> entries = [] {
    std::vector<Entry> all(kOwnPolicies.begin(), kOwnPolicies.end());
    for (const servers::Protocol protocol : servers::all_protocols()) {
      const servers::ProtocolRow& row = servers::row_of(protocol);
      all.push_back(
          {row.word, row.argument, Kind::kServer, {.draws = true}, row.meaning, protocol});
    }
    for (const servers::Scheme& scheme : servers::url_schemes()) {
      all.push_back({scheme.word,
                     "//HOST/PATH?profile=NAME",
                     Kind::kServer,
                     {.draws = true},
                     scheme.meaning,
                     {},
                     &scheme});
    }
    return all;
  }();
  return entries;
}

std::string form(const Entry& entry) {
  std::string text(entry.name);
  if (!entry.argument.empty()) text.append(":").append(entry.argument);
  return text;
}

Failure unknown(std::string_view name) {
  std::vector<std::string> names;
  for (const Entry& entry : all_policies()) names.emplace_back(entry.name);
  std::string help = policy_help();
  help.pop_back();  // the last line's end
  return {Fault::kUsage,
          "unknown policy `" + std::string(name) + "`" + did_you_mean(name, names) +
              "\nthe policies are:\n" + help,
          "--policy"};
}

struct Choice {
  const Entry* entry = nullptr;
  std::string argument;
};

Result<Choice> choose(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  for (const Entry& entry : all_policies()) {
    if (entry.name != name) continue;
    const std::string argument = policy_argument(text);
    if (entry.argument.empty() && colon != std::string_view::npos) {
      return Failure{Fault::kUsage, "policy `" + std::string(name) + "` takes no argument",
                     "--policy"};
    }
    if (!entry.argument.empty() && argument.empty()) {
      return Failure{Fault::kUsage,
                     "policy `" + std::string(name) + "` is written `" + form(entry) + "`",
                     "--policy"};
    }
    return Choice{&entry, argument};
  }
  return unknown(name);
}

Result<servers::ServerChoice> server_of(const Choice& choice) {
  if (choice.entry->scheme != nullptr)
    return servers::choose_server(*choice.entry->scheme, choice.argument);
  return servers::choose_server(*choice.entry->protocol, choice.argument);
}

Failure nothing_to_accept(std::string_view policy) {
  return {Fault::kUsage,
          "`" + std::string(policy) +
              "` shows no certificate that could be left unchecked: it is no wss:// or https://",
          "--insecure"};
}

Result<double> read_sigma(const std::string& text, std::string_view policy) {
  double sigma = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sigma);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(sigma) ||
      sigma < 0 || sigma > 1) {
    return Failure{Fault::kUsage,
                   "SIGMA of `" + std::string(policy) +
                       ":SIGMA` is a length in metres from 0 to 1, found `" + text + "`",
                   "--policy"};
  }
  return sigma;
}

// The first distractor among the privileged view's roles.
constexpr int kDistractor = 2;

Result<std::unique_ptr<policy::Policy>> make_scripted(Kind kind) {
  expert::ExpertOptions options;
  if (kind == Kind::kReach) options.close = false;
  if (kind != Kind::kWrong) return expert::make_expert(options);
  options.source = kDistractor;
  PROBE_ASSIGN(std::unique_ptr<policy::Policy> expert, expert::make_expert(options));
  return policy::make_still_without(kDistractor, std::move(expert));
}

}  // namespace

Result<PolicyChoice> choose_policy(std::string_view text, bool accepts_any_certificate) {
  PROBE_ASSIGN(const Choice choice, choose(text));
  PolicyChoice chosen{std::string(text), choice.entry->traits, nullptr};
  if (choice.entry->kind == Kind::kNoisy || choice.entry->kind == Kind::kPushed) {
    PROBE_ASSIGN(const double sigma, read_sigma(choice.argument, choice.entry->name));
    chosen.traits.draws = sigma > 0;
  }
  if (choice.entry->kind == Kind::kWeak) {
    PROBE_ASSIGN(const policy::WeakSpot spot, policy::read_weak_spot(choice.argument));
    chosen.traits.draws = std::ranges::any_of(
        spot.terms, [](const policy::WeakSpot::Term& term) { return term.width > 0; });
  }
  if (choice.entry->kind == Kind::kServer) {
    PROBE_ASSIGN(servers::ServerChoice server, server_of(choice));
    chosen.traits.content = servers::describe(server);
    server.server.tls.accepts_any = accepts_any_certificate;
    chosen.server = std::make_shared<servers::ServerChoice>(std::move(server));
  }
  if (accepts_any_certificate && (!chosen.server || !chosen.server->server.tls.is_on))
    return nothing_to_accept(text);
  return chosen;
}

Result<std::unique_ptr<policy::Policy>> make_policy(const PolicyChoice& chosen,
                                                    const PolicyContext& context) {
  if (chosen.server) {
    return servers::make_server(*chosen.server, context.queries, context.model, context.measured,
                                context.line, context.identity);
  }
  PROBE_ASSIGN(const Choice choice, choose(chosen.text));
  switch (choice.entry->kind) {
    case Kind::kNull:
      return policy::make_null();
    case Kind::kRandom:
      return policy::make_random();
    case Kind::kReplay:
      return policy::make_recorded(choice.argument, context.recorded_actions);
    case Kind::kNoisy:
    case Kind::kPushed: {
      PROBE_ASSIGN(const double sigma, read_sigma(choice.argument, choice.entry->name));
      PROBE_ASSIGN(std::unique_ptr<policy::Policy> expert, make_scripted(Kind::kExpert));
      return choice.entry->kind == Kind::kNoisy ? policy::make_noisy(std::move(expert), sigma)
                                                : policy::make_pushed(std::move(expert), sigma);
    }
    case Kind::kWeak: {
      PROBE_ASSIGN(policy::WeakSpot spot, policy::read_weak_spot(choice.argument));
      PROBE_ASSIGN(std::unique_ptr<policy::Policy> expert, make_scripted(Kind::kExpert));
      return policy::make_weak(std::move(spot), std::move(expert));
    }
    case Kind::kExpert:
    case Kind::kReach:
    case Kind::kWrong:
      return make_scripted(choice.entry->kind);
    case Kind::kServer:
      break;
  }
  return Failure{Fault::kInternal, "a server was not chosen", "--policy"};
}

Result<servers::ServerChoice> server_choice(std::string_view text, bool accepts_any_certificate) {
  PROBE_ASSIGN(const PolicyChoice choice, choose_policy(text, accepts_any_certificate));
  if (choice.server) return *choice.server;
  return Failure{Fault::kUsage, "policy `" + std::string(text) + "` is no server", "--policy"};
}

std::string policy_argument(std::string_view text) {
  const std::size_t colon = text.find(':');
  return std::string(colon == std::string_view::npos ? "" : text.substr(colon + 1));
}

std::string policy_help() {
  std::string text;
  for (const Entry& entry : all_policies()) {
    std::string line = "  " + form(entry);
    line.resize(std::max<std::size_t>(line.size() + 2, 36), ' ');
    text += line + std::string(entry.meaning) + "\n";
  }
  return text;
}

}  // namespace probe::run
