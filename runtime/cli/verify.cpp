// vlaprobe verify
#include <fmt/format.h>

#include <cstring>
#include <set>

#include "runtime/base/counted.h"
#include "runtime/base/json.h"
#include "runtime/base/say.h"
#include "runtime/cli/load.h"
#include "runtime/plan/ids.h"

namespace probe::cli {
namespace {

struct VerifyArguments {
  std::string file;
  bool fast = false, json = false;
};

struct Counts {
  std::size_t instructions = 0, starts = 0, prompts = 0, judges = 0;  // the last three: different
};

Counts count(const plan::Plan& plan) {
  std::set<std::array<std::uint8_t, 32>> starts, judges, prompts;
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
    judges.insert(plan.tasks()[t].judge_id);
    prompts.insert(plan::prompt_id(plan.tables(), t).bytes);
  }
  for (const plan::EpisodeRecord& episode : plan.episodes()) starts.insert(episode.start_id);
  return {plan.tables().code.size(), starts.size(), prompts.size(), judges.size()};
}

std::vector<plan::DirectoryEntry> directory(const plan::Plan& plan) {
  plan::Header header;
  std::memcpy(&header, plan.bytes().data(), sizeof header);
  std::vector<plan::DirectoryEntry> entries(header.sections);
  if (entries.empty()) return entries;
  std::memcpy(entries.data(), plan.bytes().data() + sizeof header,
              entries.size() * sizeof(plan::DirectoryEntry));
  return entries;
}

std::string section_name(const plan::DirectoryEntry& entry) {
  const plan::SectionInfo* info = plan::find_section(entry.kind);
  return info == nullptr ? fmt::format("{}", entry.kind) : info->name;
}

void print_json(const plan::Plan& plan, const Counts& counts, bool fast) {
  Json json = {{"root", to_hex(plan.root())},
               {"bytes", plan.bytes().size()},
               {"identity", !fast},
               {"tasks", plan.tasks().size()},
               {"episodes", plan.episodes().size()},
               {"programs", plan.programs().size()},
               {"instructions", counts.instructions},
               {"starts", counts.starts},
               {"prompts", counts.prompts},
               {"judges", counts.judges}};
  json["sections"] = Json::array();
  for (const plan::DirectoryEntry& entry : directory(plan)) {
    json["sections"].push_back({{"name", section_name(entry)},
                                {"offset", entry.offset},
                                {"size", entry.size},
                                {"count", entry.count},
                                {"ignorable", (entry.flags & plan::kIgnorable) != 0},
                                {"sha256", to_hex(Sha256{entry.sha256})}});
  }
  put("{}\n", json.dump(1));
}

int verify_verb(const VerifyArguments& arguments) {
  const auto plan = plan::Plan::open(arguments.file, {.identity = !arguments.fast});
  if (!plan) return report(plan.failure());
  const Counts counts = count(*plan);
  if (arguments.json) {
    print_json(*plan, counts, arguments.fast);
  } else {
    put("{}\n", to_hex(plan->root()));
  }
  say("{}: good, {}, {}, {} bytes\n", arguments.file, counted(plan->tasks().size(), "task"),
      counted(plan->episodes().size(), "episode"), plan->bytes().size());
  say("  envelope  {} sections as long as they say, with the SHA-256 they say\n",
      directory(*plan).size());
  say("  tables    every index, text and number\n");
  say("  code      {} programs, {} instructions\n", plan->programs().size(), counts.instructions);
  if (arguments.fast) {
    say("  identity  left out\n");
  } else {
    say("  identity  {} starts, {} prompts and {} judges give {} episode ids\n", counts.starts,
        counts.prompts, counts.judges, plan->episodes().size());
  }
  return kFine;
}

}  // namespace

void add_verify(Verb app, int& exit) {
  auto arguments = std::make_shared<VerifyArguments>();
  Verb verb = app.add_subcommand("verify", "check every rule of the plan format on a file");
  verb.footer("example: vlaprobe verify intact.plan");
  verb.add_option("X.plan", arguments->file, "plan file").required();
  verb.add_flag("--fast", arguments->fast, "without recomputing the ids");
  verb.add_flag("--json", arguments->json, "root, counts and sections as a JSON object");
  verb.callback([arguments, &exit] { exit = verify_verb(*arguments); });
}

}  // namespace probe::cli
