#include "runtime/search/search.h"

#include <fmt/format.h>

#include <filesystem>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/search/hunt.h"

namespace probe::search {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "vlaprobe search";
constexpr int kVersion = 1;
// Share of trials: what a policy cannot be judged in is not left out as if by chance.
constexpr double kMostInvalid = 0.1;
constexpr std::string_view kMethods[] = {"boundary", "worst", "minimal", "axes"};

std::string file_of(const std::string& folder) { return path_in(folder, kSearchFile); }

// What a folder is begun with; of boundaries and minimal sets the budget may grow later.
Json asked_of(const SearchOptions& options, const BaseTask& base, const std::string& content,
              const std::vector<double>& whole) {
  Json asked = {{"method", to_text(options.method)},
                {"space", base.space().name},
                {"task", base.task().name},
                {"text_sha256", base.hash()},
                {"policy", options.run.name.empty() ? options.run.policy : options.run.name},
                {"policy_content", content},
                {"seed", options.seed},
                {"error", options.error},
                {"levels", options.levels},
                {"proved_by_expert", options.proves}};
  // What is drawn at the start, and how many rounds there are, follows from it.
  if (options.method == Method::kWorst || options.method == Method::kAxes)
    asked["budget"] = options.budget ? Json(*options.budget) : Json(nullptr);
  if (options.method == Method::kMinimal) asked["case"] = json_of(base.space(), whole);
  if (options.method == Method::kWorst && options.run.shards > 1)
    asked[kShardKey] = fmt::format("{}/{}", options.run.shard, options.run.shards);
  return asked;
}

Result<Json> read_json(const std::string& folder) {
  PROBE_ASSIGN(const std::string text,
               read_file(file_of(folder), {.most = std::size_t{256} << 20, .code = Fault::kStore}));
  Json json = Json::parse(text);
  if (json.is_discarded() || json.value("format", "") != kFormat)
    return Failure{Fault::kStore, "it is not what a search wrote", file_of(folder)};
  if (json.value("version", Json(0)) != Json(kVersion))
    return Failure{Fault::kStore,
                   "it was written by another version of the format (" +
                       json.value("version", Json(0)).dump() + ", this program reads " +
                       std::to_string(kVersion) + ")",
                   file_of(folder)};
  const Json* const asked = json.find("asked");
  if (asked == nullptr || !asked->is_object())
    return Failure{Fault::kStore, "it does not say what was asked (`asked`)", file_of(folder)};
  for (const char* const key : {"method", "task", "space", "text_sha256"}) {
    const Json* const value = asked->find(key);
    if (value == nullptr || !value->is_string())
      return Failure{Fault::kStore,
                     "it does not say what was asked (`asked." + std::string(key) + "`)",
                     file_of(folder)};
  }
  return json;
}

// Whether a policy's episodes are stored there: before that nothing is bound to what was asked.
bool has_episodes(const std::string& folder) {
  const auto rounds = list_folder((fs::path(folder) / "rounds").string());
  if (!rounds) return false;
  for (const std::string& round : *rounds) {
    if (is_folder((fs::path(folder) / "rounds" / round / "policy").string())) return true;
  }
  return false;
}

// The folder is this search's, or none yet.
Status check_folder(const std::string& folder, const Json& asked) {
  if (!is_there(file_of(folder))) {
    if (!is_folder(folder)) return {};
    PROBE_ASSIGN(const auto names, list_folder(folder));
    if (names.empty()) return {};
    return Failure{Fault::kUsage, "the folder is there and is no search's: choose another", folder};
  }
  PROBE_ASSIGN(const Json there, read_json(folder));
  const Json& before_asked = there.at("asked");
  if (before_asked.contains("shards"))
    return Failure{Fault::kUsage,
                   "the folder holds shards that were joined: `search show` tells what they found, "
                   "another search has another folder",
                   folder};
  if (!has_episodes(folder)) return {};
  if (before_asked.contains(kShardKey) && !asked.contains(kShardKey))
    return Failure{Fault::kUsage,
                   "the folder holds shard " + before_asked.value(kShardKey, "") +
                       " of a search: --shard goes on with it, another search has another folder",
                   folder};
  for (const auto& [key, value] : asked.items()) {
    const Json* const before = before_asked.find(key);
    if (before != nullptr && *before == value) continue;
    if (key == "text_sha256")
      return Failure{Fault::kUsage,
                     "the text has changed since the folder was begun: choose another folder",
                     folder};
    return Failure{Fault::kUsage,
                   "the folder was begun with another " + key + " (" +
                       (before == nullptr ? "none" : before->dump()) + ", now " + value.dump() +
                       "): choose another folder",
                   folder};
  }
  return {};
}

Status check_options(const SearchOptions& options) {
  const auto refused = [](const std::string& why, const char* where) {
    return Failure{Fault::kUsage, why, where};
  };
  if (options.levels < 3 || options.levels > 401)
    return refused("expected 3 to 401 levels", "--levels");
  if (!(options.error > 0 && options.error <= 0.5))
    return refused("expected more than 0 % and at most 50 %", "--error");
  if (options.budget && (*options.budget < 1 || *options.budget > 1'000'000))
    return refused("expected 1 to 1,000,000 trials", "--budget");
  if (options.run.shards > 1 && options.method == Method::kMinimal)
    return refused(
        "what `minimal` asks next depends on all that it asked before, so it is not shared out: "
        "each --case can be a call of its own, and --jobs runs several episodes at once",
        "--shard");
  if (options.run.shards > kMostWorstShards && options.method == Method::kWorst)
    return refused(fmt::format("a search for the worst has {} shards at most", kMostWorstShards),
                   "--shard");
  return {};
}

}  // namespace

std::string_view to_text(Method method) { return kMethods[static_cast<std::size_t>(method)]; }

std::optional<Method> method_of(std::string_view word) {
  for (std::size_t i = 0; i < std::size(kMethods); ++i) {
    if (kMethods[i] == word) return static_cast<Method>(i);
  }
  return std::nullopt;
}

Result<SearchSummary> search(const SearchOptions& options, std::string& said) {
  PROBE_TRY(check_options(options));
  PROBE_ASSIGN(const run::Actor actor, run::choose_actor(options.run));
  if (actor.traits.recorded)
    return Failure{Fault::kUsage,
                   "recorded actions are of episodes that were run, a search runs others",
                   "--policy"};
  PROBE_ASSIGN(const std::unique_ptr<BaseTask> base, BaseTask::open(options.text, said));
  Case whole;
  if (options.method == Method::kMinimal) {
    PROBE_ASSIGN(whole, case_of(options, *base));
  }
  const Json asked = asked_of(options, *base, actor.traits.content, whole.values);
  PROBE_TRY(check_folder(options.run.out, asked));
  PROBE_TRY(check_search_folder(options.run.out));
  PROBE_TRY(make_lasting_folders(options.run.out));
  SearchSummary summary;
  summary.findings = {{"format", kFormat},
                      {"version", kVersion},
                      {"asked", asked},
                      {"file", absolute_path(options.text.file)},
                      {"done", false}};
  if (!is_there(file_of(options.run.out)) || !has_episodes(options.run.out))
    PROBE_TRY(write_search(options.run.out, summary.findings));
  Hunt hunt{.options = options,
            .base = *base,
            .summary = summary,
            .stored_points = StoredPoints(*base),
            .whole = std::move(whole)};
  constexpr Status (*kSearch[])(Hunt&) = {search_boundary, search_worst, search_minimal,
                                          search_axes};
  PROBE_TRY(kSearch[static_cast<std::size_t>(options.method)](hunt));
  Json& found = summary.findings;
  if (summary.invalid > 0) {
    const std::string what = fmt::format("{} of {} trials are invalid and left out, first {}",
                                         summary.invalid, summary.trials, summary.first_invalid);
    if (summary.invalid > kMostInvalid * summary.trials)
      return Failure{Fault::kPolicy, what + ". Of such a policy nothing is said", options.run.out};
    summary.lines.insert(summary.lines.begin(), what);
  }
  // Of the worst a shard is a search of its own.
  if (options.run.shards > 1 && options.method != Method::kWorst) {
    summary.is_done = false;
    summary.lines = {
        fmt::format("shard {} of {} has run; `vlaprobe merge` joins the folders, and the same "
                    "command on what it writes tells what was found",
                    options.run.shard, options.run.shards)};
    return summary;
  }
  found["done"] = summary.is_done;
  found["trials"] = summary.trials;
  found["episodes"] = summary.episodes;
  found["left_out"] = summary.left_out;
  found["invalid"] = summary.invalid;
  if (hunt.solved) {
    found["expert_starts"] = hunt.solved->known();
    found["expert_unsolved"] = hunt.solved->unsolved();
    found["expert_not_attempted"] = hunt.solved->not_attempted();
    if (hunt.solved->known() > 0 && hunt.solved->not_attempted() == hunt.solved->known())
      return Failure{Fault::kUsage,
                     "the expert has no skills for `" + base->task().name +
                         "`, so nothing here can be shown to be solvable; --unproved searches "
                         "without that",
                     options.text.file};
  }
  if (!hunt.kept.empty()) {
    PROBE_ASSIGN(const std::string file, file_inside(options.run.out, "found.probe"));
    PROBE_TRY(write_found(*base, hunt.kept, file));
    summary.notes.push_back("what was found, as variants to keep: " + file);
  }
  Json lines = Json::array();
  for (const std::string& line : summary.lines) lines.push_back(line);
  found["lines"] = std::move(lines);
  PROBE_TRY(write_search(options.run.out, found));
  return summary;
}

Status write_search(const std::string& folder, const Json& findings) {
  const std::string text = findings.dump(1) + "\n";
  PROBE_ASSIGN(const std::string file, file_inside(folder, kSearchFile));
  return write_file(file, std::as_bytes(std::span(text.data(), text.size())));
}

Status check_search_folder(const std::string& folder) {
  PROBE_TRY(check_holds_no_other(folder, FolderKind::kSearch));
  PROBE_TRY(check_all_inside(folder, "rounds"));
  const auto rounds = list_folder((fs::path(folder) / "rounds").string());
  for (const std::string& round : rounds ? *rounds : std::vector<std::string>{})
    PROBE_TRY(check_all_inside(folder, "rounds/" + round));
  return {};
}

bool is_search(const std::string& folder) { return is_file(file_of(folder)); }

Result<SearchSummary> read_search(const std::string& folder) {
  SearchSummary summary;
  PROBE_ASSIGN(summary.findings, read_json(folder));
  const auto count = [&](const char* key) {
    const Json* const value = summary.findings.find(key);
    return value != nullptr && value->is_number() ? value->get<int>() : 0;
  };
  summary.trials = count("trials");
  summary.episodes = count("episodes");
  summary.left_out = count("left_out");
  summary.invalid = count("invalid");
  const Json* const done = summary.findings.find("done");
  summary.is_done = done != nullptr && done->is_boolean() && done->get<bool>();
  if (!summary.is_done && summary.findings.find("lines") == nullptr)
    summary.lines.push_back("not finished: the same `search` command goes on with it");
  if (const Json* const lines = summary.findings.find("lines")) {
    for (const Json& line : *lines) {
      if (line.is_string()) summary.lines.push_back(line.text());
    }
  }
  return summary;
}

}  // namespace probe::search
