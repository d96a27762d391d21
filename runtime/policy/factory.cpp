// The table of policies and the reading of their names.
#include "runtime/policy/factory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "runtime/expert/expert.h"
#include "runtime/policy/simple.h"

namespace probe::policy {
namespace {

enum class Kind { kExpert, kNull, kRandom, kReach, kWrong, kNoisy, kReplay, kServer };

struct Entry {
  std::string_view name;      // what stands before ':'
  std::string_view argument;  // what must follow it, for people; empty: nothing may
  Kind kind;
  PolicyTraits traits;
  std::string_view meaning;
};

constexpr std::array kPolicies = {
    Entry{"expert", "", Kind::kExpert, {}, "the scripted expert, which sees the world's state"},
    Entry{"null", "", Kind::kNull, {}, "stays where it is, gripper open"},
    Entry{"random", "", Kind::kRandom, {true, false}, "uniform actions"},
    Entry{"reach", "", Kind::kReach, {}, "goes to the source and never closes"},
    Entry{"wrong", "", Kind::kWrong, {}, "the expert on the first distractor"},
    Entry{"noisy", "SIGMA", Kind::kNoisy, {true, false}, "the expert with noise, SIGMA in metres"},
    Entry{"replay", "DIR", Kind::kReplay, {true, true}, "the recorded actions of another run"},
    Entry{"openpi", "//HOST:PORT?profile=NAME", Kind::kServer, {true, false}, "an openpi server"},
    Entry{"intact", "//HOST:PORT?model=PATH", Kind::kServer, {true, false}, "an INT-ACT server"},
    Entry{"vlaeval", "//HOST:PORT", Kind::kServer, {true, false}, "a vla-eval server"},
    Entry{"gr00t", "//HOST:PORT", Kind::kServer, {true, false}, "a GR00T server"},
    Entry{"openvla", "//HOST:PORT", Kind::kServer, {true, false}, "an OpenVLA server"},
};

// Edits between two words, a swap of neighbours counting as one.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> table(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) table[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) table[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t swap = a[i - 1] == b[j - 1] ? 0 : 1;
      std::size_t best =
          std::min({table[i - 1][j] + 1, table[i][j - 1] + 1, table[i - 1][j - 1] + swap});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = std::min(best, table[i - 2][j - 2] + 1);
      }
      table[i][j] = best;
    }
  }
  return table[a.size()][b.size()];
}

std::string form(const Entry& entry) {
  std::string text(entry.name);
  if (!entry.argument.empty()) text.append(":").append(entry.argument);
  return text;
}

Failure unknown(std::string_view name) {
  const Entry* nearest = nullptr;
  std::size_t distance = 3;  // further away than two edits is no misspelling
  std::string known;
  for (const Entry& entry : kPolicies) {
    known += (known.empty() ? "" : ", ") + form(entry);
    const std::size_t d = edits(name, entry.name);
    if (d < distance && d < entry.name.size()) {
      distance = d;
      nearest = &entry;
    }
  }
  std::string message = "unknown policy `" + std::string(name) + "`";
  if (nearest != nullptr) message += ", did you mean `" + form(*nearest) + "`?";
  return {"usage", message + "; known: " + known, "--policy"};
}

struct Choice {
  const Entry* entry = nullptr;
  std::string argument;
};

Result<Choice> choose(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  for (const Entry& entry : kPolicies) {
    if (entry.name != name) continue;
    const std::string argument(colon == std::string_view::npos ? "" : text.substr(colon + 1));
    if (entry.argument.empty() && colon != std::string_view::npos) {
      return Failure{"usage", "policy `" + std::string(name) + "` takes no argument", "--policy"};
    }
    if (!entry.argument.empty() && argument.empty()) {
      return Failure{"usage", "policy `" + std::string(name) + "` is written `" + form(entry) + "`",
                     "--policy"};
    }
    return Choice{&entry, argument};
  }
  return unknown(name);
}

Result<double> read_sigma(const std::string& text) {
  double sigma = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sigma);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(sigma) ||
      sigma < 0 || sigma > 1) {
    return Failure{"usage",
                   "SIGMA of `noisy:SIGMA` is a length in metres from 0 to 1, found `" + text + "`",
                   "--policy"};
  }
  return sigma;
}

// The first distractor among the privileged view's roles.
constexpr int kDistractor = 2;

Result<std::unique_ptr<Policy>> make_scripted(Kind kind) {
  expert::ExpertOptions options;
  if (kind == Kind::kReach) options.close = false;
  if (kind == Kind::kWrong) options.source = kDistractor;
  return expert::make_expert(options);
}

}  // namespace

Result<PolicyTraits> policy_traits(std::string_view text) {
  PROBE_ASSIGN(const Choice choice, choose(text));
  if (choice.entry->kind == Kind::kNoisy) {
    PROBE_ASSIGN(const double sigma, read_sigma(choice.argument));
    return PolicyTraits{sigma > 0, false};
  }
  return choice.entry->traits;
}

Result<std::unique_ptr<Policy>> make_policy(std::string_view text, const PolicyContext& context) {
  PROBE_ASSIGN(const Choice choice, choose(text));
  switch (choice.entry->kind) {
    case Kind::kNull:
      return make_null();
    case Kind::kRandom:
      return make_random();
    case Kind::kReplay:
      return make_recorded(choice.argument, context);
    case Kind::kNoisy: {
      PROBE_ASSIGN(const double sigma, read_sigma(choice.argument));
      PROBE_ASSIGN(std::unique_ptr<Policy> expert, make_scripted(Kind::kExpert));
      return make_noisy(std::move(expert), sigma);
    }
    case Kind::kExpert:
    case Kind::kReach:
    case Kind::kWrong:
      return make_scripted(choice.entry->kind);
    case Kind::kServer:
      break;
  }
  return Failure{"usage", "policy servers are not available yet: `" + std::string(text) + "`",
                 "--policy"};
}

std::string policy_help() {
  std::string text;
  for (const Entry& entry : kPolicies) {
    std::string line = "  " + form(entry);
    line.resize(std::max<std::size_t>(line.size() + 2, 36), ' ');
    text += line + std::string(entry.meaning) + "\n";
  }
  return text;
}

}  // namespace probe::policy
