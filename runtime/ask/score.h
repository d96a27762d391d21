// Rows of answers as counts: by question and start, circular and plain, with intervals, floors and
// what was not read. Knows no files, servers or policies.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/stats/intervals.h"

namespace probe::ask {

// One question about one start (or the end of one recorded episode) under one arm: what came of all
// its rotations together.
struct Asked {
  // Of the plan's questions and episodes; questions of other tasks with the same words, options and
  // right answer, asked of the very same start, are answered by the same rows: the first stands
  // here.
  std::uint32_t question = 0, episode = 0;
  int seed = -1;
  Arm arm = Arm::kPicture;
  std::uint32_t rotations = 1;
  // Rows: of these valid ones that were not read (`cut`: of the unclear ones those that the server
  // did not finish), and invalid ones. rows - invalid may be less than
  // rotations while a folder is being filled.
  std::int64_t rows = 0, unclear = 0, cut = 0, refused = 0, empty = 0, invalid = 0;
  // All rotations right; none while one is missing or invalid.
  std::optional<bool> circular = {};
  // The one rotation (episode's index % rotations) right, by which right letters are balanced over
  // starts; none while it is missing or invalid.
  std::optional<bool> plain = {};
  // The same by the letter with the largest log-probability, where the server gave them; a tie is
  // not right.
  std::optional<bool> likely_circular = {}, likely_plain = {};
  // Of a choice at the plain rotation: which letter was right, and which was given.
  std::optional<std::uint32_t> right_letter = {}, given_letter = {};
  std::optional<bool> expects_yes = {};  // of a yes or no, where a valid row tells
  std::optional<double> copied = {};     // of a free answer
};

// Rows in any order, one at a time, in memory that grows with questions and starts alone.
class Tally {
 public:
  explicit Tally(const plan::Plan& plan);  // which must live as long

  // Fails (kStore) on a row whose question or start the plan does not have, or that came before; an
  // invalid one that fits nowhere counts nowhere.
  Status add(const AnswerRow& row);

  // By question in the plan's order, episode, seed, arm.
  std::vector<Asked> asked() const;

 private:
  struct Seen {
    Asked asked;
    std::vector<std::optional<bool>> right, likely;  // by rotation; none: missing or invalid
    std::vector<bool> has;
  };
  using Key = std::tuple<std::uint32_t, std::uint32_t, int, Arm>;

  const plan::Plan& plan_;
  std::map<std::string, std::vector<std::uint32_t>, std::less<>> questions_;  // by id
  std::map<Key, Seen> seen_;
};

struct Rate {
  stats::Count count;        // of questions and starts
  stats::Interval interval;  // stats::clustered_rate: 95 %, starts that lie in one place a cluster
};

struct ArmScore {
  std::int64_t rows = 0, unclear = 0, cut = 0, refused = 0, empty = 0, invalid = 0;
  std::int64_t incomplete = 0;  // questions and starts without a circular verdict
  Rate circular, plain;
  std::optional<Rate> likely_circular, likely_plain;  // none: no row has log-probabilities
  // Choices at the plain rotation: how often each letter was right and how often it was given.
  std::vector<std::int64_t> right_letters, given_letters;
  // Free answers: the mean of the shares copied, and how many copy every word of the instruction's
  // own without being right.
  std::optional<double> copied;
  std::int64_t copies = 0;
};

// What is got without looking, computed and not asked: `random` any answer as likely, each rotation
// for itself; `first` always A, always yes. Of choices and yes or no; of others nothing is said.
// The measured floors are the arms kBlind and kPrior.
struct Floors {
  std::optional<double> random_circular, random_plain, first_circular, first_plain;
};

struct ScoreRow {
  std::uint32_t family = plan::kNone;  // of the plan's families
  std::uint32_t set = plan::kNone;     // of the plan's sets, of tasks; kNone: all tasks
  std::array<std::optional<ArmScore>, 3> arms = {};  // by Arm
  Floors floors = {};                                // of what was asked under any arm
  const std::optional<ArmScore>& of(Arm arm) const { return arms[static_cast<std::size_t>(arm)]; }
};

// A row a family that was asked, in the plan's order; with `by_set` a row a family and set of the
// plan that has tasks of it.
std::vector<ScoreRow> score(const plan::Plan& plan, std::span<const Asked> asked,
                            bool by_set = false);

// Whether the model knows what a family asks, for setting beside what a policy does: a task and a
// start, with all tasks that share the question. `family` is "SET.FAMILY" or the family's name
// where one set alone has it.
struct Known {
  std::uint32_t task = 0, episode = 0;  // of the plan's
  int seed = -1;
  std::optional<bool> knows;   // Asked::circular
  std::size_t asked = 0;       // whose; several tasks that share a question have the same
  std::uint32_t question = 0;  // of the plan's: this task's
};
Result<std::vector<Known>> knows(const plan::Plan& plan, std::span<const Asked> asked,
                                 std::string_view family, Arm arm = Arm::kPicture);

}  // namespace probe::ask
