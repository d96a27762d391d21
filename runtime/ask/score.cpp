#include "runtime/ask/score.h"

#include <algorithm>
#include <set>
#include <utility>

#include "runtime/ask/queries.h"
#include "runtime/ask/reading/read_answer.h"
#include "runtime/ask/truth.h"
#include "runtime/base/numbering.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/family_name.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/places.h"
#include "runtime/plan/questions.h"
#include "runtime/stats/clustered.h"

namespace probe::ask {
namespace {

std::string id_text(const std::array<std::uint8_t, 32>& bytes) {
  return to_hex(plan::to_sha256(bytes));
}

plan::QuestionForm form_at(const plan::Plan& plan, std::uint32_t question) {
  return plan::form_of(plan.families()[plan.questions()[question].family]);
}

bool is_choice(const plan::Plan& plan, std::uint32_t question) {
  return form_at(plan, question) == plan::QuestionForm::kChoice;
}

// Where an option stands among `count` when the option `rotation` is shown first.
std::uint32_t place_at(std::uint32_t option, std::uint32_t rotation, std::uint32_t count) {
  return (option + count - rotation % count) % count;
}

std::uint32_t plain_rotation(const plan::Plan& plan, const Asked& asked) {
  return plan.episodes()[asked.episode].index % asked.rotations;
}

// The option whose letter has the largest log-probability; none on a tie or without any.
std::optional<std::uint32_t> likeliest(const AnswerRow& row, std::uint32_t count) {
  const auto& letters = row.usage.letter_logprobs;
  std::optional<std::uint32_t> best;
  bool tie = false;
  for (std::uint32_t place = 0; place < std::min<std::size_t>(count, letters.size()); ++place) {
    if (!letters[place]) continue;
    if (best && *letters[place] == *letters[*best]) tie = true;
    if (best && *letters[place] <= *letters[*best]) continue;
    best = place;
    tie = false;
  }
  if (!best || tie) return std::nullopt;
  return (*best + row.rotation) % count;
}

// All of them, as one; none while one is missing.
std::optional<bool> all_of(const std::vector<std::optional<bool>>& each) {
  bool all = true;
  for (const auto& one : each) {
    if (!one) return std::nullopt;
    all = all && *one;
  }
  return all;
}

// The episode of `question`'s task that begins as `row` says.
std::optional<std::uint32_t> episode_like(const plan::Plan& plan, std::uint32_t question,
                                          std::uint32_t index, std::string_view start_id) {
  const plan::TaskRecord& task = plan.tasks()[plan.questions()[question].task];
  if (index >= task.episodes.count) return std::nullopt;
  const std::uint32_t episode = task.episodes.first + index;
  if (id_text(plan.episodes()[episode].start_id) != start_id) return std::nullopt;
  return episode;
}

// Questions by what is asked and is right, for finding who shares a row.
class Sharing {
 public:
  explicit Sharing(const plan::Plan& plan) : plan_(plan) {
    for (std::uint32_t q = 0; q < plan.questions().size(); ++q)
      alike_[plan.questions()[q].question_id].push_back(q);
  }

  // Every task, with its episode, whose question the rows of `asked` answer, and of which family
  // that is: two sets may ask the same.
  struct Place {
    std::uint32_t task = 0, episode = 0, family = 0, question = 0;
  };
  std::vector<Place> places_of(const Asked& asked) const {
    const plan::EpisodeRecord& episode = plan_.episodes()[asked.episode];
    std::vector<Place> out;
    for (const std::uint32_t q : alike_.at(plan_.questions()[asked.question].question_id)) {
      const std::uint32_t t = plan_.questions()[q].task;
      const plan::TaskRecord& task = plan_.tasks()[t];
      if (episode.index >= task.episodes.count) continue;
      const std::uint32_t other = task.episodes.first + episode.index;
      if (plan_.episodes()[other].start_id == episode.start_id)
        out.push_back({t, other, plan_.questions()[q].family, q});
    }
    return out;
  }

 private:
  const plan::Plan& plan_;
  std::map<std::array<std::uint8_t, 32>, std::vector<std::uint32_t>> alike_;
};

// ---- rates ------------------------------------------------------------------------------------

// A verdict each question and start, as rows of task and start.
class RateMaker {
 public:
  explicit RateMaker(const plan::Plan& plan) : plan_(plan) {}

  void add(const Asked& asked, const std::optional<bool>& verdict) {
    if (!verdict) return;
    stats::Count& count = counts_[{plan_.questions()[asked.question].task, asked.episode}];
    ++count.n;
    if (*verdict) ++count.k;
  }

  Rate make() const {
    Rate rate{{}, {0, 1}};
    Numbering<std::uint32_t> tasks;
    Numbering<std::string> places;
    std::vector<stats::StartCount> rows;
    for (const auto& [where, count] : counts_) {
      const plan::TaskRecord& task = plan_.tasks()[where.first];
      const std::string place = plan::place_key(plan_, task, plan_.episodes()[where.second]);
      rows.push_back({count, tasks(where.first), places(place)});
      rate.count.k += count.k;
      rate.count.n += count.n;
    }
    if (!rows.empty()) rate.interval = stats::clustered_rate(rows);
    return rate;
  }

 private:
  const plan::Plan& plan_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, stats::Count> counts_;  // by task, episode
};

void count_letter(std::vector<std::int64_t>& letters, std::optional<std::uint32_t> letter) {
  if (!letter) return;
  if (letters.size() <= *letter) letters.resize(*letter + 1);
  ++letters[*letter];
}

ArmScore score_arm(const plan::Plan& plan, const std::vector<const Asked*>& asked) {
  ArmScore out;
  RateMaker circular(plan), plain(plan), likely_circular(plan), likely_plain(plan);
  bool is_likely = false;
  double copied = 0;
  std::int64_t free = 0;
  for (const Asked* one : asked) {
    out.rows += one->rows;
    out.unclear += one->unclear;
    out.cut += one->cut;
    out.refused += one->refused;
    out.empty += one->empty;
    out.invalid += one->invalid;
    if (!one->circular) ++out.incomplete;
    circular.add(*one, one->circular);
    plain.add(*one, one->plain);
    likely_circular.add(*one, one->likely_circular);
    likely_plain.add(*one, one->likely_plain);
    is_likely = is_likely || one->likely_plain || one->likely_circular;
    count_letter(out.right_letters, one->right_letter);
    count_letter(out.given_letters, one->given_letter);
    if (!one->copied) continue;
    ++free;
    copied += *one->copied;
    if (*one->copied >= 1 && one->plain == false) ++out.copies;
  }
  const std::size_t letters = std::max(out.right_letters.size(), out.given_letters.size());
  out.right_letters.resize(letters);
  out.given_letters.resize(letters);
  out.circular = circular.make();
  out.plain = plain.make();
  if (is_likely) {
    out.likely_circular = likely_circular.make();
    out.likely_plain = likely_plain.make();
  }
  if (free > 0) out.copied = copied / static_cast<double>(free);
  return out;
}

// A mean of what is known.
class Mean {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  std::optional<double> get() const {
    if (count_ == 0) return std::nullopt;
    return sum_ / static_cast<double>(count_);
  }

 private:
  double sum_ = 0;
  std::int64_t count_ = 0;
};

Floors floors_of(const plan::Plan& plan, const std::vector<const Asked*>& asked) {
  Mean random_circular, random_plain, first_circular, first_plain;
  for (const Asked* one : asked) {
    const plan::QuestionForm form = form_at(plan, one->question);
    if (form == plan::QuestionForm::kChoice) {
      const double chance = 1 / static_cast<double>(one->rotations);
      double all = 1;
      for (std::uint32_t i = 0; i < one->rotations; ++i) all *= chance;
      random_plain.add(chance);
      random_circular.add(all);
      if (!one->right_letter) continue;
      first_plain.add(*one->right_letter == 0 ? 1 : 0);
      first_circular.add(one->rotations == 1 ? 1 : 0);
    } else if (form == plan::QuestionForm::kYesNo) {
      random_plain.add(0.5);
      random_circular.add(0.5);
      if (!one->expects_yes) continue;
      first_plain.add(*one->expects_yes ? 1 : 0);
      first_circular.add(*one->expects_yes ? 1 : 0);
    }
  }
  return {random_circular.get(), random_plain.get(), first_circular.get(), first_plain.get()};
}

}  // namespace

Tally::Tally(const plan::Plan& plan) : plan_(plan) {
  for (std::uint32_t q = 0; q < plan.questions().size(); ++q)
    questions_[id_text(plan.questions()[q].question_id)].push_back(q);
}

Status Tally::add(const AnswerRow& row) {
  const auto alike = questions_.find(row.question_id);
  // What is invalid may be so because it fits nowhere.
  if (alike == questions_.end() && row.invalid) return {};
  if (alike == questions_.end())
    return Failure{Fault::kStore, "the plan has no question " + row.question_id, row.task};
  std::optional<std::uint32_t> episode;
  std::uint32_t question = 0;
  for (const std::uint32_t q : alike->second) {
    question = q;
    episode = episode_like(plan_, q, static_cast<std::uint32_t>(row.episode), row.start_id);
    if (episode) break;
  }
  if (!episode && row.invalid) return {};
  if (!episode)
    return Failure{Fault::kStore,
                   "the plan asks " + row.question_id + " about no start " + row.start_id,
                   row.task};
  const std::uint32_t rotations = rotations_of(plan_, plan_.questions()[question]);
  if (row.rotation >= rotations && row.invalid) return {};
  Seen& seen = seen_[{question, *episode, row.seed, row.arm}];
  if (seen.has.empty()) {
    seen.asked = {.question = question, .episode = *episode, .seed = row.seed, .arm = row.arm};
    seen.asked.rotations = rotations;
    seen.right.resize(rotations);
    seen.likely.resize(rotations);
    seen.has.resize(rotations);
  }
  if (row.rotation >= rotations || seen.has[row.rotation])
    return Failure{Fault::kStore,
                   "rotation " + std::to_string(row.rotation) + " of " + row.question_id +
                       " stands there twice, or is not one",
                   row.task};
  seen.has[row.rotation] = true;

  Asked& asked = seen.asked;
  ++asked.rows;
  if (row.invalid || !row.right) {
    ++asked.invalid;
    return {};
  }
  seen.right[row.rotation] = row.right;
  switch (row.reading.verdict) {
    case Verdict::kRead:
      break;
    case Verdict::kUnclear:
      ++asked.unclear;
      if (row.reading.rule == kCutRule) ++asked.cut;
      break;
    case Verdict::kRefused:
      ++asked.refused;
      break;
    case Verdict::kEmpty:
      ++asked.empty;
      break;
  }
  const plan::QuestionRecord& record = plan_.questions()[question];
  const bool is_proved = plan::truth_of(record) == plan::QuestionTruth::kProved;
  // Whatever was read, so that the floors are the same for all models.
  if (form_at(plan_, question) == plan::QuestionForm::kYesNo)
    asked.expects_yes = is_proved ? record.right == 1 : told_yes(row.expected);
  asked.copied = row.copied;
  if (!is_choice(plan_, question) || !is_proved) return {};
  if (std::ranges::any_of(row.usage.letter_logprobs,
                          [](const auto& logprob) { return logprob.has_value(); })) {
    seen.likely[row.rotation] = likeliest(row, rotations) == record.right;
  }
  if (row.rotation != plain_rotation(plan_, asked)) return {};
  asked.right_letter = place_at(record.right, row.rotation, rotations);
  if (row.reading.option)
    asked.given_letter = place_at(*row.reading.option, row.rotation, rotations);
  return {};
}

std::vector<Asked> Tally::asked() const {
  std::vector<Asked> out;
  for (const auto& [key, seen] : seen_) {
    Asked asked = seen.asked;
    const std::uint32_t plain = plain_rotation(plan_, asked);
    asked.circular = all_of(seen.right);
    asked.plain = seen.right[plain];
    asked.likely_circular = all_of(seen.likely);
    asked.likely_plain = seen.likely[plain];
    out.push_back(asked);
  }
  return out;
}

std::vector<ScoreRow> score(const plan::Plan& plan, std::span<const Asked> asked, bool by_set) {
  const Sharing sharing(plan);
  std::vector<std::set<std::uint32_t>> sets;
  if (by_set) {
    for (const plan::SetRecord& set : plan.sets()) {
      const auto members = plan.members(set);
      sets.emplace_back(members.begin(), members.end());
    }
  }
  // By family, then set: what was asked.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<const Asked*>> groups;
  for (const Asked& one : asked) {
    // Once in each group, in however many of its tasks it is asked.
    std::set<std::pair<std::uint32_t, std::uint32_t>> keys;
    for (const Sharing::Place& place : sharing.places_of(one)) {
      if (!by_set) keys.emplace(place.family, plan::kNone);
      for (std::uint32_t set = 0; set < sets.size(); ++set) {
        if (sets[set].contains(place.task)) keys.emplace(place.family, set);
      }
    }
    for (const auto& key : keys) groups[key].push_back(&one);
  }
  std::vector<ScoreRow> out;
  for (const auto& [key, members] : groups) {
    ScoreRow row{.family = key.first, .set = key.second};
    row.floors = floors_of(plan, members);
    for (const Arm arm : {Arm::kPicture, Arm::kBlind, Arm::kPrior}) {
      std::vector<const Asked*> of_arm;
      std::copy_if(members.begin(), members.end(), std::back_inserter(of_arm),
                   [&](const Asked* one) { return one->arm == arm; });
      if (!of_arm.empty()) row.arms[static_cast<std::size_t>(arm)] = score_arm(plan, of_arm);
    }
    out.push_back(std::move(row));
  }
  return out;
}

Result<std::vector<Known>> knows(const plan::Plan& plan, std::span<const Asked> asked,
                                 std::string_view family, Arm arm) {
  std::vector<std::uint32_t> named;
  for (std::uint32_t f = 0; f < plan.families().size(); ++f) {
    if (plan::is_called(plan, plan.families()[f], family)) named.push_back(f);
  }
  if (named.empty())
    return Failure{Fault::kUsage, "no questions are called `" + std::string(family) + "`", ""};
  if (named.size() > 1)
    return Failure{Fault::kUsage,
                   "several sets have questions called `" + std::string(family) +
                       "`: say which, as SET." + std::string(family),
                   ""};
  const Sharing sharing(plan);
  std::vector<Known> out;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Asked& one = asked[i];
    if (one.arm != arm) continue;
    for (const Sharing::Place& place : sharing.places_of(one)) {
      if (place.family == named[0])
        out.push_back({place.task, place.episode, one.seed, one.circular, i, place.question});
    }
  }
  std::sort(out.begin(), out.end(), [](const Known& a, const Known& b) {
    return std::tuple(a.task, a.episode, a.seed, a.question) <
           std::tuple(b.task, b.episode, b.seed, b.question);
  });
  return out;
}

}  // namespace probe::ask
