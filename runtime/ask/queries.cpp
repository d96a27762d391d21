#include "runtime/ask/queries.h"

#include <algorithm>
#include <map>
#include <set>

#include "runtime/base/glob.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/spelling.h"
#include "runtime/plan/family_name.h"
#include "runtime/plan/questions.h"
#include "runtime/run/selection.h"

namespace probe::ask {
namespace {

using Id = std::array<std::uint8_t, 32>;

// Which families the globs mean; every glob has to mean one.
Result<std::vector<bool>> choose_families(const plan::Plan& plan,
                                          const std::vector<std::string>& globs) {
  std::vector<bool> chosen(plan.families().size(), globs.empty());
  for (const std::string& glob : globs) {
    bool any = false;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const plan::FamilyRecord& family = plan.families()[i];
      names.emplace_back(plan.text(family.set));
      names.push_back(plan::family_name(plan, family));
      if (!matches_glob(glob, names.back()) && !matches_glob(glob, plan.text(family.set))) continue;
      any = chosen[i] = true;
    }
    if (any) continue;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::string message = "no questions are called `" + glob + "`";
    const std::string near = did_you_mean(glob, names);
    message += near.empty() ? "; the plan has:" : near;
    for (std::size_t i = 0; near.empty() && i < names.size(); ++i) message += "\n  " + names[i];
    return Failure{Fault::kUsage, std::move(message), "--questions"};
  }
  return chosen;
}

// The suite that is asked when none is named: the first with a task that has questions.
std::string asked_suite(const plan::Plan& plan) {
  std::set<std::uint32_t> asked;
  for (const plan::QuestionRecord& question : plan.questions()) asked.insert(question.task);
  for (const plan::SuiteRecord& suite : plan.suites()) {
    const auto members = plan.members(suite);
    if (std::ranges::any_of(members, [&](std::uint32_t task) { return asked.contains(task); }))
      return std::string(plan.text(suite.name));
  }
  return {};
}

// The objects of a task, ascending: its bodies before the first surface.
std::vector<std::uint32_t> objects_of(const plan::Plan& plan, std::uint32_t task) {
  std::vector<std::uint32_t> objects;
  for (const plan::BodyRecord& body : plan.bodies(plan.tasks()[task])) {
    if (body.kind == static_cast<std::uint32_t>(plan::BodyKind::kObject))
      objects.push_back(body.index);
  }
  std::ranges::sort(objects);
  return objects;
}

// What is chosen of a plan's tasks and their starts, questions aside.
Result<run::Selection> select_starts(const plan::Plan& plan, const QueryChoice& choice) {
  if (!choice.whole_plan || plan.suites().empty()) {
    run::RunOptions asked;
    asked.suite = choice.suite.empty() ? asked_suite(plan) : choice.suite;
    asked.tasks = choice.tasks;
    asked.episodes = choice.episodes;
    asked.seeds = {0};
    return run::select_jobs(plan, asked, false);
  }
  run::Selection selection;
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) {
    const plan::TaskRecord& record = plan.tasks()[task];
    if (!matches_glob(choice.tasks, plan.text(record.name))) continue;
    for (std::uint32_t index = 0; index < record.episodes.count; ++index) {
      const int at = static_cast<int>(index);
      if (choice.episodes && (at < choice.episodes->first || at > choice.episodes->second))
        continue;
      selection.jobs.push_back({task, index, 0});
    }
  }
  return selection;
}

}  // namespace

Result<Arm> arm_of(std::string_view word) {
  for (const Arm arm : {Arm::kPicture, Arm::kBlind, Arm::kPrior}) {
    if (word == word_of(arm)) return arm;
  }
  return Failure{Fault::kUsage,
                 "an arm is picture, blind or prior, found `" + std::string(word) + "`", "--arms"};
}

std::uint32_t rotations_of(const plan::Plan& plan, const plan::QuestionRecord& question) {
  return plan::form_of(plan.families()[question.family]) == plan::QuestionForm::kChoice
             ? question.options.count
             : 1;
}

std::optional<std::uint32_t> prior_of(const plan::Plan& plan, std::uint32_t episode) {
  const plan::EpisodeRecord& own = plan.episodes()[episode];
  const std::vector<std::uint32_t> seen = objects_of(plan, own.task);
  std::vector<std::uint32_t> best;  // tasks
  int best_rank = 0;
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) {
    const auto episodes = plan.episodes(plan.tasks()[task]);
    const bool has_other = std::ranges::any_of(
        episodes, [&](const plan::EpisodeRecord& e) { return e.start_id != own.start_id; });
    if (!has_other) continue;
    const int rank = task == own.task ? 1 : objects_of(plan, task) == seen ? 2 : 3;
    if (rank < best_rank) continue;
    if (rank > best_rank) best.clear();
    best_rank = rank;
    best.push_back(task);
  }
  if (best.empty()) return std::nullopt;
  // The task is drawn by the own task's first start, so that neighbours look at one other task.
  const Sha256 first{plan.episodes(plan.tasks()[own.task]).front().start_id};
  const std::uint64_t draw = little_endian_number(Hasher().text("prior task").hash(first).finish());
  const std::uint32_t task = best[draw % best.size()];
  const std::uint32_t begin = plan.tasks()[task].episodes.first;
  const std::uint32_t count = plan.tasks()[task].episodes.count;
  const Sha256 start{own.start_id};
  const std::uint64_t from =
      little_endian_number(Hasher().text("prior start").hash(start).finish()) % count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at = begin + static_cast<std::uint32_t>((from + i) % count);
    if (plan.episodes()[at].start_id != own.start_id) return at;
  }
  return std::nullopt;
}

std::vector<std::uint32_t> Queries::questions_of(std::uint32_t task,
                                                 plan::QuestionMoment moment) const {
  const auto all = plan_->questions();
  const auto by_task = [](const plan::QuestionRecord& question, std::uint32_t wanted) {
    return question.task < wanted;
  };
  std::vector<std::uint32_t> found;
  for (auto at = std::lower_bound(all.begin(), all.end(), task, by_task);
       at != all.end() && at->task == task; ++at) {
    if (chosen_[at->family] && plan::moment_of(plan_->families()[at->family]) == moment)
      found.push_back(static_cast<std::uint32_t>(at - all.begin()));
  }
  return found;
}

std::vector<Query> Queries::of(const Look& look) const {
  const auto moment = look.recorded ? plan::QuestionMoment::kEnd : plan::QuestionMoment::kStart;
  std::vector<std::uint32_t> episodes = {look.episode};
  episodes.insert(episodes.end(), look.others.begin(), look.others.end());
  std::vector<Query> queries;
  std::set<std::pair<Id, int>> known;
  for (const std::uint32_t episode : episodes) {
    for (const std::uint32_t number : questions_of(plan_->episodes()[episode].task, moment)) {
      const plan::QuestionRecord& question = plan_->questions()[number];
      if (!known.emplace(question.question_id, index_in_task(*plan_, episode)).second) continue;
      const std::uint32_t rotations = rotations_of(*plan_, question);
      for (const Arm arm : choice_.arms) {
        for (std::uint32_t rotation = 0; rotation < rotations; ++rotation)
          queries.push_back({number, episode, look.seed, rotation, arm});
      }
    }
  }
  return queries;
}

Result<Queries> Queries::choose(const plan::Plan& plan, QueryChoice choice) {
  if (plan.questions().empty()) {
    return Failure{Fault::kUsage,
                   "the plan asks nothing: declare `questions`, and name them in a suite", "F"};
  }
  Queries made(plan);
  PROBE_ASSIGN(made.chosen_, choose_families(plan, choice.questions));
  PROBE_ASSIGN(const run::Selection selection, select_starts(plan, choice));
  if (choice.shards < 1 || choice.shard < 1 || choice.shard > choice.shards) {
    return Failure{Fault::kUsage,
                   "shard " + std::to_string(choice.shard) + "/" + std::to_string(choice.shards) +
                       " is not one of 1/N .. N/N",
                   "--shard"};
  }
  made.suite_ = selection.suite;
  if (choice.suite.empty() && !choice.whole_plan && plan.suites().size() > 1) {
    made.notes_.push_back("suite `" + made.suite_ +
                          "`, the first that is asked something; --suite names another");
  }
  made.choice_ = std::move(choice);

  // Starts in the plan's order; equal ones together.
  std::map<Id, std::size_t> begun;
  std::set<std::uint32_t> tasks, ends;
  std::set<std::uint32_t> selected;
  for (const run::EpisodeJob& job : selection.jobs) {
    const std::uint32_t episode = plan.tasks()[job.task].episodes.first + job.index;
    selected.insert(episode);
    if (!made.questions_of(job.task, plan::QuestionMoment::kEnd).empty()) ends.insert(job.task);
    if (made.questions_of(job.task, plan::QuestionMoment::kStart).empty()) continue;
    tasks.insert(job.task);
    const Id& start = plan.episodes()[episode].start_id;
    const auto [at, is_new] = begun.try_emplace(start, made.looks_.size());
    if (is_new) {
      made.looks_.push_back({episode, {}});
    } else {
      made.looks_[at->second].others.push_back(episode);
    }
  }
  if (made.choice_.recorded) {
    std::set<std::uint32_t> there;
    for (std::size_t i = 0; i < made.choice_.recorded->size(); ++i) {
      const RecordedEnd& end = (*made.choice_.recorded)[i];
      const std::uint32_t task = plan.episodes()[end.episode].task;
      if (!selected.contains(end.episode) || !ends.contains(task)) continue;
      tasks.insert(task);
      there.insert(end.episode);
      made.looks_.push_back({end.episode, {}, i, end.seed});
    }
    const auto wanted = std::ranges::count_if(selected, [&](std::uint32_t episode) {
      return ends.contains(plan.episodes()[episode].task);
    });
    if (const auto missing = wanted - std::ssize(there); missing > 0) {
      made.notes_.push_back("the ends of " + std::to_string(missing) + " of " +
                            std::to_string(wanted) +
                            " chosen starts are not asked about: the run of --frames has no valid "
                            "episode of them");
    }
  } else if (!ends.empty()) {
    made.notes_.push_back(
        "what is asked about the end of an episode is left out: --frames RUN "
        "names the run that was recorded");
  }
  if (made.looks_.empty()) {
    return Failure{Fault::kUsage,
                   ends.empty() ? "none of the chosen tasks is asked any of the chosen questions"
                                : "all that was chosen is asked about the end of an episode; name "
                                  "a run that holds these episodes with --frames",
                   ends.empty() ? "--questions" : "--frames"};
  }
  made.tasks_.assign(tasks.begin(), tasks.end());
  std::erase_if(made.looks_, [&](const Look& look) {
    const Sha256 start{plan.episodes()[look.episode].start_id};
    return run::shard_of(start, look.seed.value_or(-1), made.choice_.shards) != made.choice_.shard;
  });
  for (const Look& look : made.looks_) {
    made.count_ += static_cast<std::int64_t>(made.of(look).size());
  }
  return made;
}

}  // namespace probe::ask
