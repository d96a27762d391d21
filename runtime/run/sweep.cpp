// Run, score, choose, run.
#include "runtime/run/sweep.h"

#include <filesystem>
#include <map>
#include <set>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/inside.h"
#include "runtime/base/json.h"
#include "runtime/base/percent.h"
#include "runtime/plan/plan.h"
#include "runtime/run/selection.h"
#include "runtime/servers/servers.h"
#include "runtime/store/proof.h"
#include "runtime/store/store.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlace = "{}";
constexpr const char* kRule =
    "highest mean over the original tasks of the share of successes; of equals the one with the "
    "higher mean share of intentions; of these the first named";

Failure misused(const std::string& message, const char* where) {
  return {Fault::kUsage, message, where};
}

std::string with_checkpoint(std::string text, const std::string& checkpoint) {
  for (std::size_t at = 0; (at = text.find(kPlace, at)) != std::string::npos;) {
    text.replace(at, kPlace.size(), checkpoint);
    at += checkpoint.size();
  }
  return text;
}

Status check_checkpoints(const SweepOptions& options) {
  if (options.run.policy.find(kPlace) == std::string::npos) {
    return misused("`" + options.run.policy +
                       "` has no {} for a checkpoint, as in intact://HOST:PORT?model={}",
                   "--policy");
  }
  if (!options.run.name.empty() && options.run.name.find(kPlace) == std::string::npos) {
    return misused("`" + options.run.name + "` has no {}: all checkpoints would have one name",
                   "--name");
  }
  if (options.checkpoints.empty()) return misused("no checkpoint is named", "--checkpoints");
  std::set<std::string> known;
  for (const std::string& checkpoint : options.checkpoints) {
    if (checkpoint.empty()) return misused("a checkpoint's text is empty", "--checkpoints");
    if (!known.insert(checkpoint).second) {
      return misused("`" + checkpoint + "` is named twice", "--checkpoints");
    }
  }
  return {};
}

// What a run of each checkpoint could not do either; and a server that loads what it likes, asked
// for two checkpoints, would be compared with itself.
Status check_policies(const SweepOptions& options) {
  std::map<std::string, std::string> asked;  // a server that ignores checkpoints: the first of them
  for (const std::string& checkpoint : options.checkpoints) {
    const std::string policy = with_checkpoint(options.run.policy, checkpoint);
    PROBE_ASSIGN(const PolicyChoice choice,
                 choose_policy(policy, options.run.accepts_any_certificate));
    const servers::ServerChoice* const server = choice.server.get();
    if (server == nullptr || server->profile.checkpoint == servers::CheckpointUse::kNamed) continue;
    const auto [first, is_first] = asked.emplace(server->server.name(), checkpoint);
    if (is_first) continue;
    return misused("the server at " + first->first +
                       " does not load the checkpoint that it is told (`" +
                       "checkpoint = ignored` in profile `" + server->profile.name + "`): `" +
                       first->second + "` and `" + checkpoint +
                       "` would be one model; start a server for each and write {} into the port",
                   "--policy");
  }
  return {};
}

RunOptions run_of(const SweepOptions& options, const std::string& checkpoint) {
  RunOptions run = options.run;
  run.policy = with_checkpoint(run.policy, checkpoint);
  run.name = with_checkpoint(run.name, checkpoint);
  run.out = (fs::path(options.run.out) / checkpoint_folder(checkpoint)).string();
  return run;
}

double value_of(const store::ResultRow& row, const char* metric) {
  for (const store::MetricValue& value : row.metrics) {
    if (value.name == metric) return value.value;
  }
  return 0;
}

// Of the rows of the original tasks that `run` chose; its folder may hold more.
Result<CheckpointScore> score_of(const plan::Plan& plan, const RunOptions& run,
                                 const std::string& checkpoint) {
  PROBE_ASSIGN(const PolicyChoice choice, choose_policy(run.policy));
  PROBE_ASSIGN(const Selection selection, select_jobs(plan, run, choice.traits.draws));
  std::set<store::EpisodeKey> chosen;
  for (const EpisodeJob& job : selection.jobs) chosen.insert(key_of(plan, job));
  PROBE_ASSIGN(const auto proven, store::read_proven_results(run.out));
  struct Sums {
    double episodes = 0, success = 0, intention = 0;
  };
  std::map<std::string, Sums> tasks;
  CheckpointScore score;
  score.checkpoint = checkpoint;
  score.dir = run.out;
  for (const store::ResultRow& row : proven.rows) {
    if (row.invalid || !chosen.contains(store::key_of(row))) continue;
    Sums& sums = tasks[row.task];
    ++sums.episodes;
    sums.success += value_of(row, "success");
    sums.intention += value_of(row, "intention");
    ++score.episodes;
  }
  if (static_cast<std::size_t>(score.episodes) != chosen.size()) {
    return Failure{Fault::kPolicy,
                   std::to_string(chosen.size() - static_cast<std::size_t>(score.episodes)) +
                       " of " + std::to_string(chosen.size()) +
                       " episodes are invalid, so no checkpoint is chosen; the same command runs "
                       "them again",
                   run.out};
  }
  score.tasks = static_cast<int>(tasks.size());
  for (const auto& [name, sums] : tasks) {
    score.success += sums.success / sums.episodes / score.tasks;
    score.intention += sums.intention / sums.episodes / score.tasks;
  }
  return score;
}

// Of the newest call that asked; a folder that was whole before was asked then.
std::string answers_of(const std::string& dir) {
  std::string hash;
  if (const auto calls = store::read_run_calls(dir)) {
    for (const store::RunCall& call : *calls) {
      if (call.reading && !call.reading->answers_sha256.empty())
        hash = call.reading->answers_sha256;
    }
  }
  return hash;
}

// Two checkpoints that answer alike may be one model.
std::vector<std::string> alike(const std::vector<CheckpointScore>& scores) {
  std::vector<std::string> sentences;
  std::map<std::string, std::string> first_with;
  for (const CheckpointScore& score : scores) {
    if (score.answers_sha256.empty()) continue;
    const auto [first, is_first] = first_with.emplace(score.answers_sha256, score.checkpoint);
    if (is_first) continue;
    sentences.push_back("checkpoints `" + first->second + "` and `" + score.checkpoint +
                        "` answer bit for bit the same: are they one model?");
  }
  return sentences;
}

bool is_better(const CheckpointScore& a, const CheckpointScore& b) {
  return a.success != b.success ? a.success > b.success : a.intention > b.intention;
}

std::string percent(double share) { return decimal_text(100 * share, 1) + " %"; }

std::string sentence(const CheckpointScore& score) {
  return score.checkpoint + ": success " + percent(score.success) + ", intention " +
         percent(score.intention) + " over " + std::to_string(score.tasks) + " original tasks, " +
         std::to_string(score.episodes) + " episodes";
}

Status write_choice(const plan::Plan& plan, const SweepOptions& options,
                    const SweepSummary& summary) {
  Json json;
  json["plan_root"] = to_hex(plan.root());
  json["policy"] = options.run.policy;
  json["rule"] = kRule;
  json["best"] = summary.scores[summary.best].checkpoint;
  json["checkpoints"] = Json::array();
  for (const CheckpointScore& score : summary.scores) {
    json["checkpoints"].push_back({{"checkpoint", score.checkpoint},
                                   {"folder", fs::path(score.dir).filename().string()},
                                   {"tasks", score.tasks},
                                   {"episodes", score.episodes},
                                   {"success", score.success},
                                   {"intention", score.intention},
                                   {"answers_sha256", score.answers_sha256}});
  }
  json["alike"] = summary.alike;
  const std::string text = json.dump(2) + "\n";
  PROBE_ASSIGN(const std::string file,
               file_inside(options.run.out, folder_row(FolderKind::kSweep).mark));
  return write_file(file, std::as_bytes(std::span(text)));
}

}  // namespace

std::string checkpoint_folder(const std::string& checkpoint) {
  constexpr std::size_t kLongest = 40;
  std::string name;
  for (const char c : checkpoint) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    name.push_back(plain ? c : '_');
  }
  if (name == checkpoint && name.size() <= kLongest && !name.starts_with(".")) return name;
  if (name.size() > kLongest) name = name.substr(name.size() - kLongest);
  while (name.starts_with(".") || name.starts_with("_")) name.erase(0, 1);
  return name + (name.empty() ? "" : "-") +
         to_hex(sha256(std::string_view(checkpoint))).substr(0, 8);
}

Status check_sweep(const SweepOptions& options) {
  PROBE_TRY(check_checkpoints(options));
  return check_policies(options);
}

Result<SweepSummary> sweep(const plan::Plan& plan, const SweepOptions& options) {
  PROBE_TRY(check_sweep(options));
  PROBE_TRY(check_holds_no_other(options.run.out, FolderKind::kSweep));
  for (const std::string& checkpoint : options.checkpoints)
    PROBE_TRY(check_inside(options.run.out, checkpoint_folder(checkpoint)));
  const auto tell = [&](const std::string& text) {
    if (options.tell) options.tell(text);
  };
  SweepSummary summary;
  for (const std::string& checkpoint : options.checkpoints) {
    RunOptions originals = run_of(options, checkpoint);
    originals.originals = true;
    tell("checkpoint " + checkpoint + " on the original tasks");
    PROBE_ASSIGN(const RunSummary ran, run(plan, originals));
    originals.out = ran.out;  // a fork, perhaps
    PROBE_ASSIGN(CheckpointScore score, score_of(plan, originals, checkpoint));
    score.answers_sha256 = answers_of(originals.out);
    tell(sentence(score));
    summary.scores.push_back(std::move(score));
  }
  summary.alike = alike(summary.scores);
  for (const std::string& sentence : summary.alike) tell(sentence);
  for (std::size_t i = 1; i < summary.scores.size(); ++i) {
    if (is_better(summary.scores[i], summary.scores[summary.best])) summary.best = i;
  }
  PROBE_TRY(write_choice(plan, options, summary));
  const CheckpointScore& best = summary.scores[summary.best];
  tell("best: " + best.checkpoint + "; now the whole suite");
  RunOptions whole = run_of(options, best.checkpoint);
  whole.out = best.dir;
  PROBE_ASSIGN(summary.whole, run(plan, whole));
  return summary;
}

}  // namespace probe::run
