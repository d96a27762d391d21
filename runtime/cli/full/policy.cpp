// vlaprobe policy: servers tested, ready profiles shown.
#include <fmt/format.h>

#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/run/policies.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/profile_library.h"

namespace probe::cli {
namespace {

struct PolicyArguments {
  std::string policy, profile;
  bool json = false;
};

int test_verb(const PolicyArguments& arguments) {
  const auto choice = run::server_choice(arguments.policy);
  if (!choice) return report(choice.failure());
  const auto tested = servers::test_server(*choice);
  if (!tested) return report(tested.failure());
  if (arguments.json) {
    put("{}\n", servers::to_json(*tested));
  } else {
    put("{}", servers::to_text(*tested));
  }
  return tested->is_wrong() ? kOutside : kFine;
}

int profiles_verb(const PolicyArguments& arguments) {
  if (arguments.profile.empty()) {
    for (const servers::ProfileText& ready : servers::ready_profiles()) {
      const auto profile = servers::find_profile(ready.name);
      if (!profile) return report(profile.failure());
      put("{:<20}{:<11}{}\n", ready.name, servers::to_word(profile->protocol), profile->about);
    }
    return kFine;
  }
  for (const servers::ProfileText& ready : servers::ready_profiles()) {
    if (ready.name != arguments.profile) continue;
    put("{}", ready.text);
    return kFine;
  }
  // A file: read, checked and written out as it is understood.
  const auto profile = servers::find_profile(arguments.profile);
  if (!profile) return report(profile.failure());
  put("{}", servers::to_text(*profile));
  return kFine;
}

}  // namespace

void add_policy(Verb app, int& exit) {
  auto arguments = std::make_shared<PolicyArguments>();
  Verb verb = app.add_subcommand("policy", "test a policy server; show ready profiles");
  verb.require_subcommand();
  verb.footer("example: vlaprobe policy test openpi://localhost:8000?profile=pi0_bridge_openpi");

  Verb test = verb.add_subcommand(
      "test", "does a server agree with its profile: shapes, rotation, gripper, chunks, sameness");
  test.footer(
      "Asks about ten known observations, runs no simulator. Exit code 2 where something is "
      "wrong.\n"
      "example: vlaprobe policy test "
      "\"intact://gpu:8000?model=/checkpoints/pi0&profile=pi0_bridge\"");
  test.add_option("P", arguments->policy, "a policy server, as for `run --policy`").required();
  test.add_flag("--json", arguments->json, "an object with a check each");
  test.refuse_empty_values();
  test.callback([arguments, &exit] { exit = test_verb(*arguments); });

  Verb profiles = verb.add_subcommand(
      "profiles", "ready profiles; with a name or a file, that one, read and checked");
  profiles.footer("fields of a profile:\n" + servers::profile_help() +
                  "\nexample: vlaprobe policy profiles copy_me > mine.profile");
  profiles.add_option("NAME", arguments->profile, "a ready profile or a .profile file");
  profiles.refuse_empty_values();
  profiles.callback([arguments, &exit] { exit = profiles_verb(*arguments); });
}

}  // namespace probe::cli
