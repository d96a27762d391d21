// vlaprobe policy: servers tested, ready profiles shown.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/assets/output_file.h"
#include "runtime/base/file.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/until_ended.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/run/policies.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/transcript.h"

namespace probe::cli {
namespace {

struct PolicyArguments {
  std::string policy, profile, transcript;
  std::string address = "127.0.0.1", port = "0";
  bool json = false, with_questions = false, insecure = false;
};

int test_verb(const PolicyArguments& arguments) {
  const auto choice = run::server_choice(arguments.policy, arguments.insecure);
  if (!choice) return report(choice.failure());
  if (arguments.insecure) warn_of_insecure(arguments.policy);
  const auto tested = servers::test_server(*choice);
  if (!tested) return report(tested.failure());
  if (arguments.json) {
    put("{}\n", servers::to_json(*tested));
  } else {
    put_words("{}", servers::to_text(*tested));
  }
  return tested->is_wrong() ? kOutside : kFine;
}

int record_verb(const PolicyArguments& arguments) {
  const auto choice = run::server_choice(arguments.policy, arguments.insecure);
  if (!choice) return report(choice.failure());
  if (arguments.insecure) warn_of_insecure(arguments.policy);
  if (auto spared =
          assets::check_output(arguments.transcript, choice->files, assets::Writes::kTranscript);
      !spared)
    return report(spared.failure());
  const auto recorded = servers::record(*choice);
  if (!recorded) return report(recorded.failure());
  std::size_t lines = 0;
  for (const auto& connection : recorded->connections) lines += connection.size();
  if (lines == 0) {
    return report({Fault::kPolicy, "nothing was said: is a server there? `policy test` says more",
                   choice->server.name()});
  }
  const std::string text = servers::to_text(*recorded, arguments.with_questions);
  if (auto written = write_file(arguments.transcript, std::as_bytes(std::span(text))); !written)
    return report(written.failure());
  say("{} messages of {} connections in {}\n", lines, recorded->connections.size(),
      arguments.transcript);
  return kFine;
}

int replay_transcript_verb(const PolicyArguments& arguments) {
  const auto text = read_file(arguments.transcript);
  if (!text) return report(text.failure());
  const auto transcript = servers::parse_transcript(*text, arguments.transcript);
  if (!transcript) return report(transcript.failure());
  const EndSignals ends;
  const auto player =
      servers::play(*transcript, arguments.address, arguments.port,
                    [](const std::string& sentence) { say("note: {}\n", sentence); });
  if (!player) return report(player.failure());
  fmt::print("{}://{}:{}\n", servers::to_word(transcript->protocol), arguments.address,
             (*player)->port());
  std::fflush(stdout);
  ends.wait();
  return kFine;
}

int profiles_verb(const PolicyArguments& arguments) {
  if (arguments.profile.empty()) {
    std::size_t width = 0;
    for (const servers::ProfileText& ready : servers::ready_profiles())
      width = std::max(width, ready.name.size());
    for (const servers::ProfileText& ready : servers::ready_profiles()) {
      const auto profile = servers::find_profile(ready.name);
      if (!profile) return report(profile.failure());
      put_words("{:<{}}  {:<11}{}\n", ready.name, width, servers::to_word(profile->protocol),
                profile->about);
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
      "Asks about a dozen known observations, runs no simulator. Exit code 2 where something is "
      "wrong.\n"
      "example: vlaprobe policy test "
      "\"intact://gpu:8000?model=/checkpoints/pi0&profile=pi0_bridge\"");
  test.add_option("P", arguments->policy, "a policy server, as for `run --policy`").required();
  test.add_flag("--json", arguments->json, "an object with a check each");
  test.add_flag("--insecure", arguments->insecure, "accept any certificate of a wss:// server");
  test.refuse_empty_values();
  test.callback([arguments, &exit] { exit = test_verb(*arguments); });

  Verb record = verb.add_subcommand(
      "record", "write down a server's conversation over the questions of `policy test`");
  record.footer(
      "For bug reports: questions, with their pictures and instructions, are left out but for "
      "size\n"
      "and hash, unless --questions.\n"
      "example: vlaprobe policy record \"gr00t://gpu:5555?profile=gr00t_bridge\" -o "
      "gr00t.transcript");
  record.add_option("P", arguments->policy, "a policy server, as for `run --policy`").required();
  record.add_option("-o,--out", arguments->transcript, "file to write").required();
  record.add_flag("--questions", arguments->with_questions, "write what was asked, too");
  record.add_flag("--insecure", arguments->insecure, "accept any certificate of a wss:// server");
  record.refuse_empty_values();
  record.callback([arguments, &exit] { exit = record_verb(*arguments); });

  Verb replay = verb.add_subcommand("replay", "play the server's side of a recorded conversation");
  replay.footer(
      "Prints where it listens; the same questions then get the same answers. Ends with SIGINT or\n"
      "SIGTERM.\n"
      "example: vlaprobe policy replay gr00t.transcript --port 5555");
  replay.add_option("FILE", arguments->transcript, "of `policy record`").required();
  replay.add_option("--address", arguments->address, "to listen at, a number or a name");
  replay.add_option("--port", arguments->port, "to listen at; 0: any free one");
  replay.refuse_empty_values();
  replay.callback([arguments, &exit] { exit = replay_transcript_verb(*arguments); });

  Verb profiles = verb.add_subcommand(
      "profiles", "ready profiles; with a name or a file, that one, read and checked");
  profiles.footer("fields of a profile:\n" + servers::profile_help() +
                  "\nexample: vlaprobe policy profiles copy_me > mine.profile");
  profiles.add_option("NAME", arguments->profile, "a ready profile or a .profile file");
  profiles.refuse_empty_values();
  profiles.callback([arguments, &exit] { exit = profiles_verb(*arguments); });
}

}  // namespace probe::cli
