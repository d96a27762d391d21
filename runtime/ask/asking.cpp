#include "runtime/ask/asking.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <set>
#include <span>
#include <thread>

#include "runtime/ask/asked_query.h"
#include "runtime/ask/plan_reading.h"
#include "runtime/plan/questions.h"
#include "runtime/run/workers.h"

namespace probe::ask {
namespace {

// All of a row but what came.
AnswerRow begin_row(const AskingState& shared, const Query& query) {
  const plan::Plan& plan = shared.plan;
  const plan::QuestionRecord& question = plan.questions()[query.question];
  const plan::FamilyRecord& family = plan.families()[question.family];
  const AnswerKey key = key_of(plan, query);
  AnswerRow row;
  row.question_id = key.question_id;
  row.start_id = start_id_of(plan, query.episode);
  row.rotation = key.rotation;
  row.arm = key.arm;
  row.episode = key.episode;
  row.seed = key.seed;
  row.set = plan.text(family.set);
  row.family = plan.text(family.name);
  row.task = plan.text(plan.tasks()[question.task].name);
  row.model = shared.options.name;
  return row;
}

class Asker {
 public:
  Asker(AskingState& shared, std::unique_ptr<Model> model)
      : shared_(shared), model_(std::move(model)) {}

  Status run() {
    while (auto ready = shared_.ready.pop()) PROBE_TRY(ask(*ready->look, ready->query));
    return {};
  }

 private:
  Status ask(const PreparedLook& look, std::size_t index) {
    const plan::Plan& plan = shared_.plan;
    const Query& query = look.queries[index];
    const plan::QuestionRecord& question = plan.questions()[query.question];
    AnswerRow row = begin_row(shared_, query);
    if (!look.failure.empty()) {
      row.invalid = look.failure;
      return commit(std::move(row), query, false);
    }
    const Truth& truth = look.truths.at(query.question);
    const Wording wording = wording_of(plan, look, query);
    const AskedQuery asked = asked_query(plan, look, query, wording);
    row.text = wording.text;
    row.prompt_sha256 = to_hex(sha256(wording.text));
    if (asked.picture != nullptr) row.image_sha256 = asked.picture->sha256;
    row.expected = truth.expected;
    if (query.arm == Arm::kPrior) {
      row.shown_start_id = start_id_of(plan, *look.prior_episode);
      row.shown_has_answer = has_answer(plan, question, *look.prior_episode);
    }
    const auto said = model_->answer(asked);
    if (!said) {
      row.attempts = model_->failed_attempts;
      row.invalid = "model: " + to_text(said.failure());
      return commit(std::move(row), query, true);
    }
    row.raw = said->raw;
    row.reasoning = said->reasoning;
    row.usage = said->usage;
    row.request_sha256 = said->request_sha256;
    row.latency_s = said->latency_s;
    row.attempts = said->attempts;
    read(asked, said->letters, row);
    return commit(std::move(row), query, false);
  }

  static void read(const AskedQuery& asked, std::span<const WrittenLetter> letters,
                   AnswerRow& row) {
    if (plan::truth_of(asked.question) == plan::QuestionTruth::kMentions) {
      Restatement restated = restate(asked.plan, asked.question, row.raw, row.usage.finish);
      row.reading = std::move(restated.reading);
      row.right = restated.right;
      row.copied = restated.copied;
      return;
    }
    const AnswerReader reader(
        read_context(asked.plan, asked.question, asked.wording.shown, asked.width, asked.height));
    row.reading = reader.read(row.raw, row.usage.finish);
    row.usage.letter_logprobs =
        at_read_letter(reader, letters, row.raw, row.usage.finish, row.reading);
    row.right = is_right(asked.truth, row.reading);
  }

  Status commit(AnswerRow row, const Query& query, bool is_lost) {
    PROBE_TRY(shared_.answers.commit(row, query.question));
    const std::lock_guard lock(shared_.mutex);
    AskSummary& summary = shared_.summary;
    ++summary.done;
    summary.call.retried += row.attempts - 1;
    if (row.invalid) {
      ++summary.invalid;
    } else {
      ++summary.call.answers;
      if (*row.right) ++summary.right;
    }
    if (shared_.options.progress)
      shared_.options.progress({summary.done, summary.skipped, summary.total, &row});
    if (!is_lost) {
      if (!row.invalid) shared_.lost_in_a_row = 0;
      return {};
    }
    const int bound = shared_.options.give_up_after;
    if (bound == 0 || ++shared_.lost_in_a_row < bound) return {};
    return give_up(*row.invalid);
  }

  Failure give_up(const std::string& last) const {
    const AskSummary& summary = shared_.summary;
    return {Fault::kPolicy,
            "the model failed with " + std::to_string(shared_.lost_in_a_row) +
                " questions in a row, the last time so: " + last + "\n  " +
                std::to_string(summary.skipped + summary.done - summary.invalid) + " of " +
                std::to_string(summary.total) + " answers are stored in " + summary.out +
                "; when the server answers again, the same command continues",
            shared_.options.name};
  }

  AskingState& shared_;
  std::unique_ptr<Model> model_;
};

// Draws looks and hands their queries on.
class Drawer {
 public:
  explicit Drawer(AskingState& shared)
      : shared_(shared), viewer_(shared.plan, shared.assets, shared.traits.picture) {}

  Status draw(std::size_t index) {
    if (shared_.stopped) return {};
    const plan::Plan& plan = shared_.plan;
    const Look& look = shared_.queries.looks()[shared_.looks[index]];
    PROBE_ASSIGN(const Answers::Stored stored,
                 shared_.answers.stored(start_id_of(plan, look.episode)));
    auto made = std::make_shared<PreparedLook>(
        prepare(plan, look, open_queries(plan, shared_.queries, look, stored), shared_.recorded,
                shared_.traits.picture, shared_.traits.is_shown, viewer_));
    PROBE_TRY(leave_out(*made));
    const std::size_t count = made->queries.size();
    for (std::size_t query = 0; query < count; ++query) {
      if (!shared_.ready.push({made, query})) return {};
    }
    return {};
  }

 private:
  Status leave_out(PreparedLook& made) {
    const plan::Plan& plan = shared_.plan;
    std::set<AnswerKey> told;
    std::int64_t count = 0;
    for (const Query& query : made.queries) {
      const auto truth = made.truths.find(query.question);
      if (truth == made.truths.end() || truth->second.left_out.empty()) continue;
      ++count;
      AnswerKey key = key_of(plan, query);
      key.rotation = 0;
      key.arm = Arm::kPicture;
      if (!told.insert(key).second) continue;
      const AnswerRow row = begin_row(shared_, query);
      PROBE_TRY(shared_.answers.leave_out({row.question_id, row.start_id, row.episode, row.seed,
                                           row.set, row.family, row.task, truth->second.left_out},
                                          query.question));
    }
    std::erase_if(made.queries, [&](const Query& query) {
      const auto truth = made.truths.find(query.question);
      return truth != made.truths.end() && !truth->second.left_out.empty();
    });
    if (count == 0) return {};
    const std::lock_guard lock(shared_.mutex);
    shared_.summary.left_out += count;
    shared_.summary.skipped += count;
    return {};
  }

  AskingState& shared_;
  Viewer viewer_;
};

Result<std::unique_ptr<Model>> make_model(AskingState& shared) {
  const AskOptions& options = shared.options;
  if (options.own_model) return options.own_model->make();
  if (shared.chat == nullptr) return make_own_model(options.model);
  return make_chat(*shared.chat, {.queries = &shared.meter,
                                  .stopped = &shared.stopped,
                                  .retries = options.retries,
                                  .has_logprobs = shared.summary.call.proof.has_logprobs});
}

// Looks, for as long as it lives, whether the caller wants the end, and brings it about.
class Lookout {
 public:
  explicit Lookout(AskingState& shared) {
    if (shared.options.stopped) thread_ = std::thread([this, &shared] { look(shared); });
  }
  ~Lookout() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    over_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  Lookout(const Lookout&) = delete;
  Lookout& operator=(const Lookout&) = delete;

 private:
  void look(AskingState& shared) {
    constexpr auto kEvery = std::chrono::milliseconds(50);
    std::unique_lock lock(mutex_);
    while (!over_.wait_for(lock, kEvery, [this] { return is_over_; })) {
      if (!shared.options.stopped()) continue;
      shared.stopped = true;
      shared.ready.stop();
      return;
    }
  }

  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace

Status ask_all(AskingState& shared) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const auto drawers = std::min({cores, static_cast<std::size_t>(shared.options.jobs),
                                 std::max<std::size_t>(shared.looks.size(), 1)});
  const Lookout lookout(shared);
  Status drawn;
  std::thread drawing([&] {
    const auto make = [&shared]() -> Result<run::Worker> {
      const auto drawer = std::make_shared<Drawer>(shared);
      return run::Worker([drawer](std::size_t index) { return drawer->draw(index); });
    };
    drawn = run::run_jobs(shared.looks.size(), static_cast<int>(drawers), make);
    shared.ready.close();
  });
  const auto make = [&shared]() -> Result<run::Worker> {
    auto model = make_model(shared);
    if (!model) {
      shared.stopped = true;
      shared.ready.stop();
      return model.failure();
    }
    const auto asker = std::make_shared<Asker>(shared, std::move(*model));
    return run::Worker([asker, &shared](std::size_t) {
      Status asked = asker->run();
      if (!asked) {
        shared.stopped = true;
        shared.ready.stop();
      }
      return asked;
    });
  };
  const Status asked =
      run::run_jobs(static_cast<std::size_t>(shared.options.jobs), shared.options.jobs, make);
  drawing.join();
  PROBE_TRY(asked);
  PROBE_TRY(drawn);
  const AskSummary& summary = shared.summary;
  if (!shared.stopped || summary.done + summary.skipped >= summary.total) return {};
  return Failure{Fault::kPolicy, "the call was stopped; the same one continues", summary.out};
}

}  // namespace probe::ask
