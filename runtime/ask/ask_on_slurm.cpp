#include "runtime/ask/ask_on_slurm.h"

#include <set>
#include <tuple>

#include "runtime/ask/answers.h"
#include "runtime/ask/merge.h"
#include "runtime/ask/prepared.h"
#include "runtime/base/large.h"
#include "runtime/base/paths.h"
#include "runtime/run/selection.h"

namespace probe::ask {
namespace {

void add_words(std::vector<std::string>& words, const char* flag, const std::string& value) {
  words.insert(words.end(), {flag, value});
}

template <typename List, typename Text>
std::string joined(const List& list, Text text) {
  std::string all;
  for (const auto& each : list) all += (all.empty() ? "" : ",") + std::string(text(each));
  return all;
}

class AskWork final : public cluster::ArrayWork {
 public:
  AskWork(const plan::Plan& plan, const AskOptions& options, std::string own_name,
          const Queries& queries)
      : plan_(plan), options_(options), own_name_(std::move(own_name)), queries_(queries) {}

  FolderKind folder_kind() const override { return FolderKind::kAnswers; }
  std::string verb() const override { return "ask"; }
  std::string actor_flag() const override { return "--model"; }
  std::string actor() const override { return options_.model; }
  std::string name() const override { return options_.name.empty() ? own_name_ : options_.name; }
  std::string things() const override { return "answers"; }
  std::int64_t total() const override { return queries_.count(); }

  std::vector<std::string> words() const override {
    const QueryChoice& choice = options_.choice;
    std::vector<std::string> words;
    if (!choice.suite.empty()) add_words(words, "--suite", choice.suite);
    if (choice.tasks != "*") add_words(words, "--tasks", choice.tasks);
    if (choice.episodes) {
      add_words(
          words, "--episodes",
          std::to_string(choice.episodes->first) + "-" + std::to_string(choice.episodes->second));
    }
    const auto as_it_is = [](const std::string& text) { return text; };
    if (!choice.questions.empty())
      add_words(words, "--questions", joined(choice.questions, as_it_is));
    add_words(words, "--arms", joined(choice.arms, [](Arm arm) { return word_of(arm); }));
    if (!options_.frames.empty()) add_words(words, "--frames", absolute_path(options_.frames));
    for (const std::string& folder : options_.assets.folders())
      add_words(words, "--assets", absolute_path(folder));
    add_words(words, "--retries", std::to_string(options_.retries));
    add_words(words, "--give-up-after", std::to_string(options_.give_up_after));
    if (options_.if_changed == run::IfChanged::kContinue)
      add_words(words, "--if-changed", "continue");
    if (options_.accepts_any_certificate) words.emplace_back("--insecure");
    if (is_large_allowed()) words.emplace_back("--allow-large");
    return words;
  }

  Status check_same(const std::string& out) const override {
    PROBE_ASSIGN(const auto record, find_ask_record(out));
    if (!record) return {};
    AskRecord asked = *record;
    asked.identity.plan_root = to_hex(plan_.root());
    asked.identity.model = name();
    const std::string change = changes_between(*record, asked).identity;
    if (change.empty()) return {};
    return Failure{Fault::kStore, change + "; take another folder or remove this one", out};
  }
  Result<bool> is_begun(const std::string& dir) const override {
    PROBE_ASSIGN(const auto record, find_ask_record(dir));
    return record.has_value();
  }
  Result<std::map<int, std::int64_t>> missing(const std::string& dir, int shards) const override {
    return missing_answers(plan_, queries_, dir, shards);
  }
  Result<store::MergeSummary> merge(const store::MergeOptions& options) const override {
    return ask::merge(options);
  }

 private:
  const plan::Plan& plan_;
  const AskOptions& options_;
  std::string own_name_;
  const Queries& queries_;
};

}  // namespace

Result<std::map<int, std::int64_t>> missing_answers(const plan::Plan& plan, const Queries& queries,
                                                    const std::string& dir, int shards) {
  std::map<std::string, Answers::Stored> stored;  // by start
  if (holds_answers(dir)) {
    PROBE_TRY(for_each_answer(dir, [&](AnswerRow row, std::uint32_t) -> Status {
      if (row.invalid) return {};
      stored[row.start_id].answers.push_back(
          {row.question_id, row.rotation, row.arm, row.episode, row.seed});
      return {};
    }));
    PROBE_TRY(for_each_left_out(dir, [&](LeftOut out, std::uint32_t) -> Status {
      stored[out.start_id].left_out.push_back(
          {out.question_id, 0, Arm::kPicture, out.episode, out.seed});
      return {};
    }));
    for (auto& [start, keys] : stored) {
      std::ranges::sort(keys.answers);
      std::ranges::sort(keys.left_out);
    }
  }
  std::map<int, std::int64_t> lacking;
  for (const Look& look : queries.looks()) {
    const auto there = stored.find(start_id_of(plan, look.episode));
    const Answers::Stored none;
    const auto count = static_cast<std::int64_t>(
        open_queries(plan, queries, look, there == stored.end() ? none : there->second).size());
    if (count == 0) continue;
    const Sha256 start{plan.episodes()[look.episode].start_id};
    lacking[run::shard_of(start, look.seed.value_or(-1), shards)] += count;
  }
  return lacking;
}

Result<cluster::SlurmReport> ask_on_slurm(const plan::Plan& plan, const AskOptions& asking,
                                          const cluster::ArrayOptions& options) {
  std::string model = asking.model;  // its port does not matter for what it is
  for (const auto& [place, any] : {std::pair{"{port}", "1"}, std::pair{"{host}", "127.0.0.1"}}) {
    if (const auto at = model.find(place); at != std::string::npos) model.replace(at, 6, any);
  }
  PROBE_ASSIGN(const ModelTraits traits, model_traits(model, asking.accepts_any_certificate));
  QueryChoice choice = asking.choice;
  choice.shard = choice.shards = 1;
  if (!asking.frames.empty()) {
    PROBE_ASSIGN(choice.recorded, recorded_ends(plan, asking.frames));
  }
  PROBE_ASSIGN(const Queries queries, Queries::choose(plan, std::move(choice)));
  const AskWork work(plan, asking, traits.name, queries);
  return cluster::work_on_slurm(plan, work, asking.out, asking.jobs,
                                asking.if_changed == run::IfChanged::kContinue, options);
}

}  // namespace probe::ask
