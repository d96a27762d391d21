// From what stands after --policy to a Policy: the table of policies in this process, and a server
// of each of servers/protocols, by protocol or by URL.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/policy/policy.h"
#include "runtime/policy/scripted.h"

namespace probe::policy {
class QueryMeter;
}
namespace probe::servers {
class Identity;
class SharedLine;
class SharedModel;
struct ServerChoice;
}  // namespace probe::servers

namespace probe::run {

struct PolicyTraits {
  bool draws = false;             // whether two seeds can give two different episodes
  bool recorded = false;          // wants PolicyContext::recorded_actions of its argument
  bool wants_distractor = false;  // stays still in a task without one
  // Of a policy server what its name alone does not say: "profile NAME sha256 ..."; two runs of one
  // name and other content are not one run. Empty for a policy in this process.
  std::string content = {};
};

// What a policy may need from outside. `recorded_actions` gives the actions of a stored episode
// (for replay:DIR).
struct PolicyContext {
  policy::RecordedActions recorded_actions;
  policy::QueryMeter* queries = nullptr;  // of the run; told of each query to a server; may be null
  std::shared_ptr<servers::SharedModel> model = nullptr;  // of the run's connections; may be null
  std::shared_ptr<servers::SharedLine> line = nullptr;    // of its worlds' batches; may be null
  std::shared_ptr<servers::Identity> identity = nullptr;  // whom the run began with; may be null
  // Of a server: what its profile leaves open and its answers have shown, see policy::Reading.
  std::vector<std::pair<std::string, std::string>> measured = {};
};

// What stands after --policy, read once.
struct PolicyChoice {
  std::string text;
  PolicyTraits traits;
  std::shared_ptr<const servers::ServerChoice> server;  // none: a policy in this process
};

// Fails (kUsage) on an unknown policy, with the known ones and the nearest spelling, on a bad
// argument, and where a certificate that is not there is to be accepted unchecked.
Result<PolicyChoice> choose_policy(std::string_view text, bool accepts_any_certificate = false);
Result<std::unique_ptr<policy::Policy>> make_policy(const PolicyChoice& choice,
                                                    const PolicyContext& context = {});

// The same of a text that is read for this alone.
inline Result<std::unique_ptr<policy::Policy>> make_policy(std::string_view text,
                                                           const PolicyContext& context = {}) {
  PROBE_ASSIGN(const PolicyChoice choice, choose_policy(text));
  return make_policy(choice, context);
}

// Of a policy that is a server; fails (kUsage) on any other, and as choose_policy does.
Result<servers::ServerChoice> server_choice(std::string_view text,
                                            bool accepts_any_certificate = false);

// What stands after the first ':', or nothing.
std::string policy_argument(std::string_view text);

// One line each, for --help: "noisy:SIGMA   the expert with ...".
std::string policy_help();

}  // namespace probe::run
