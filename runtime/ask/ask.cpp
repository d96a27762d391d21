// Puts the parts together: model, selection, folder, proof, threads.
#include "runtime/ask/ask.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "runtime/ask/answers.h"
#include "runtime/ask/asking.h"
#include "runtime/ask/callers_proof.h"
#include "runtime/ask/chat.h"
#include "runtime/ask/prepared.h"
#include "runtime/ask/recorded.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/clock.h"
#include "runtime/run/changed_folder.h"

namespace probe::ask {
namespace {

namespace fs = std::filesystem;

// The folder to write into, by `options.if_changed`, as run's is chosen. Answers that were asked
// for in two ways are not one model's: over another build alone a folder is gone on with.
Result<std::string> choose_folder(const AskOptions& options, const AskRecord& record,
                                  std::vector<std::string>& notes) {
  const fs::path asked = fs::path(options.out).lexically_normal();
  const std::string base = (asked.has_filename() ? asked : asked.parent_path()).string();
  for (int copy = 1;; ++copy) {
    const std::string dir = copy == 1 ? options.out : base + "-" + std::to_string(copy);
    PROBE_ASSIGN(const auto stored, find_ask_record(dir));
    if (!stored) return dir;
    const AskChanges changes = changes_between(*stored, record);
    if (!changes.any()) return dir;
    const bool two = !changes.identity.empty() && !changes.content.empty();
    const std::string other = changes.identity + (two ? ", and " : "") + changes.content;
    PROBE_ASSIGN(const bool here_again,
                 run::goes_on(dir, {other, "", changes.build}, options.if_changed, notes));
    if (here_again) return dir;
  }
}

// Looks with something left to ask; counts what is there.
Result<std::vector<std::size_t>> open_looks(const plan::Plan& plan, const Queries& queries,
                                            Answers& answers, AskSummary& summary) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < queries.looks().size(); ++i) {
    const Look& look = queries.looks()[i];
    PROBE_ASSIGN(const Answers::Stored stored, answers.stored(start_id_of(plan, look.episode)));
    const std::size_t left = open_queries(plan, queries, look, stored).size();
    summary.skipped += static_cast<std::int64_t>(queries.of(look).size() - left);
    if (left > 0) open.push_back(i);
  }
  return open;
}

// Whose assets are needed: those that are looked at, and those that stand in for them.
std::vector<std::uint32_t> tasks_seen(const plan::Plan& plan, const Queries& queries) {
  std::set<std::uint32_t> tasks;
  const auto& arms = queries.choice().arms;
  const bool has_prior = std::ranges::find(arms, Arm::kPrior) != arms.end();
  for (const Look& look : queries.looks()) {
    tasks.insert(plan.episodes()[look.episode].task);
    if (!has_prior) continue;
    if (const auto other = prior_of(plan, look.episode)) tasks.insert(plan.episodes()[*other].task);
  }
  return {tasks.begin(), tasks.end()};
}

Status check_arms(const ModelTraits& traits, const std::vector<Arm>& arms) {
  for (const Arm arm : arms) {
    if (std::ranges::find(traits.arms, arm) != traits.arms.end()) continue;
    return Failure{Fault::kUsage,
                   "model `" + traits.name + "` looks at no picture, so that the arm `" +
                       std::string(word_of(arm)) + "` says nothing of it",
                   "--arms"};
  }
  return {};
}

// Of a server; else nothing.
Result<std::optional<ChatChoice>> chat_choice(const AskOptions& options) {
  std::optional<ChatChoice> choice;
  if (!options.own_model && is_chat(options.model)) {
    PROBE_ASSIGN(choice, choose_chat(options.model));
  }
  if (choice) choice->server.tls.accepts_any = options.accepts_any_certificate;
  return choice;
}

// Before the first question: the server is there, has the model, sees and reads.
Status prove(const AskOptions& options, const ChatChoice& choice, AskSummary& summary) {
  const bool shows =
      std::ranges::any_of(options.choice.arms, [](Arm arm) { return arm != Arm::kBlind; });
  PROBE_ASSIGN(summary.call.proof, prove_chat(choice, {.retries = options.retries}, shows));
  for (std::string& finding : findings_of(summary.call.proof))
    summary.notes.push_back(std::move(finding));
  return {};
}

}  // namespace

Result<AskSummary> ask(const plan::Plan& plan, const AskOptions& given) {
  AskOptions options = given;
  ModelTraits traits;
  if (options.own_model) {
    traits = options.own_model->traits;
  } else {
    PROBE_ASSIGN(traits, model_traits(options.model, options.accepts_any_certificate));
  }
  if (options.name.empty()) options.name = traits.name;
  PROBE_TRY(check_model_name(options.name, options.own_model ? "" : options.model));
  PROBE_TRY(check_arms(traits, options.choice.arms));
  PROBE_ASSIGN(const std::optional<ChatChoice> chat, chat_choice(options));
  AskSummary summary;
  Recorded recorded;
  if (!options.frames.empty()) {
    PROBE_ASSIGN(recorded, read_recorded(plan, options.frames, summary.notes));
    options.choice.recorded = recorded.ends;
  }
  PROBE_ASSIGN(const Queries queries, Queries::choose(plan, options.choice));
  summary.notes.insert(summary.notes.end(), queries.notes().begin(), queries.notes().end());
  summary.total = queries.count();
  if (queries.looks().empty()) {
    summary.notes.push_back("shard " + std::to_string(options.choice.shard) + "/" +
                            std::to_string(options.choice.shards) +
                            " holds no question: nothing to do");
    return summary;
  }
  if (std::ranges::find(options.choice.arms, Arm::kPrior) != options.choice.arms.end() &&
      !prior_of(plan, queries.looks().front().episode)) {
    return Failure{Fault::kUsage,
                   "the plan has one start alone, so that the arm `prior` has no other to show",
                   "--arms"};
  }
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(options.assets));
  // Assets are checked before the folder is touched: a plan that cannot be drawn leaves nothing.
  PROBE_ASSIGN(auto assets, stage::SharedAssets::load(plan, root, tasks_seen(plan, queries)));
  const store::Fingerprint fingerprint = store::take_fingerprint(stage::asset_digest(plan));
  const AskRecord record{{to_hex(plan.root()), options.name, traits.content, recorded.identity},
                         queries.suite(),
                         fingerprint};
  PROBE_ASSIGN(options.out, choose_folder(options, record, summary.notes));
  // A server that cannot be asked leaves no folder behind; one that goes on is asked only if there
  // is something left.
  PROBE_ASSIGN(const auto begun_before, find_ask_record(options.out));
  if (chat && !begun_before) PROBE_TRY(prove(options, *chat, summary));
  PROBE_ASSIGN(auto answers, Answers::open(options.out, record, plan.bytes()));
  summary.out = options.out;
  PROBE_ASSIGN(auto looks, open_looks(plan, queries, *answers, summary));
  if (options.progress) options.progress({0, summary.skipped, summary.total, nullptr});
  if (looks.empty()) return summary;

  summary.call.fingerprint = fingerprint;
  summary.call.jobs = options.jobs;
  summary.call.shard = options.choice.shard;
  summary.call.shards = options.choice.shards;
  if (chat && begun_before) PROBE_TRY(prove(options, *chat, summary));
  if (begun_before && options.own_model && !options.own_model->is_vouched_for)
    PROBE_TRY(check_callers_model(plan, options, queries, recorded.rows, assets, *answers,
                                  summary.notes));
  PROBE_TRY(answers->write_call(summary.call));
  // A look's queries and some of the next: what waits never outnumbers what is being asked by far.
  BoundedQueue<Ready> ready(2 * static_cast<std::size_t>(options.jobs) + 8);
  policy::QueryMeter meter;
  AskingState shared{.plan = plan,
                     .options = options,
                     .traits = traits,
                     .queries = queries,
                     .recorded = recorded.rows,
                     .looks = std::move(looks),
                     .assets = std::move(assets),
                     .answers = *answers,
                     .ready = ready,
                     .summary = summary,
                     .chat = chat ? &*chat : nullptr,
                     .meter = meter};
  const auto begun = std::chrono::steady_clock::now();
  const Status worked = ask_all(shared);
  const Status flushed = answers->flush();
  summary.call.ended = true;
  summary.call.elapsed_s = seconds_since(begun);
  summary.call.queries = meter.figures();
  const Status written = answers->write_call(summary.call);
  PROBE_TRY(worked);
  PROBE_TRY(flushed);
  PROBE_TRY(written);
  return summary;
}

}  // namespace probe::ask
