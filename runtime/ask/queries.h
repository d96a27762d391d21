// Which questions of a plan a call of `ask` means, about which starts, and in which order: picture
// by picture, so that each is drawn once however many questions it answers. Pure: nothing here
// depends on what is stored or on who else asks. Holds an entry a picture, never one a query.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

// A recorded episode whose end can be asked about.
struct RecordedEnd {
  std::uint32_t episode = 0;  // of the plan's episodes
  int seed = 0;
  std::size_t row = 0;  // of the run's rows, for whoever made the list
};

struct QueryChoice {
  std::string suite;        // empty: the first whose tasks are asked something, or all tasks
  bool whole_plan = false;  // of a text without a suite of its own: no suite, all its tasks
  std::string tasks = "*";  // glob over task names, with or without the suite's prefix
  std::optional<std::pair<int, int>> episodes;  // first and last index, both included
  std::vector<std::string> questions;           // globs over "SET" and "SET.FAMILY"; empty: all
  std::vector<Arm> arms = {Arm::kPicture};
  int shard = 1, shards = 1;
  // Of the run whose ends are asked about; none: questions at the end are left out, with a note.
  std::optional<std::vector<RecordedEnd>> recorded = {};
};

// One picture: the start of an episode, or the end of a recorded one.
struct Look {
  std::uint32_t episode = 0;                 // of the plan's episodes, the first that begins so
  std::vector<std::uint32_t> others;         // of other tasks, that begin in the very same way
  std::optional<std::size_t> recorded = {};  // of QueryChoice::recorded; none: the start itself
  std::optional<int> seed = {};              // of the recorded episode
};

class Queries {
 public:
  // The plan must live as long. Fails (kUsage) as run::select_jobs does, on a set or family that
  // the plan does not have (with the nearest), and where nothing at all is asked of what was
  // chosen, saying why.
  static Result<Queries> choose(const plan::Plan& plan, QueryChoice choice);

  const std::string& suite() const { return suite_; }
  const std::vector<Look>& looks() const { return looks_; }
  const std::vector<std::string>& notes() const { return notes_; }
  const QueryChoice& choice() const { return choice_; }
  std::int64_t count() const { return count_; }  // of queries of all looks

  // Of one look: by question, then arm, then rotation. A question that two tasks share word for
  // word (the same question_id) is asked once where their episodes have the same index, too.
  std::vector<Query> of(const Look& look) const;

  // Indices of the plan's tasks that are asked something.
  const std::vector<std::uint32_t>& tasks() const { return tasks_; }

 private:
  explicit Queries(const plan::Plan& plan) : plan_(&plan) {}
  std::vector<std::uint32_t> questions_of(std::uint32_t task, plan::QuestionMoment moment) const;

  const plan::Plan* plan_;
  QueryChoice choice_;
  std::string suite_;
  std::vector<bool> chosen_;  // by family
  std::vector<std::uint32_t> tasks_;
  std::vector<Look> looks_;
  std::vector<std::string> notes_;
  std::int64_t count_ = 0;
};

// By word_of()'s word. Fails (kUsage, --arms).
Result<Arm> arm_of(std::string_view word);

// Letters of a choice's options, or 1: in how many orders a question is asked.
std::uint32_t rotations_of(const plan::Plan& plan, const plan::QuestionRecord& question);

// Which episode's picture the prior arm shows with a question about `episode`: of another task with
// other objects where the plan has one, else of another task, else another start of the same; drawn
// by a hash of the start, whatever else is chosen. Nothing where the plan has one start alone.
std::optional<std::uint32_t> prior_of(const plan::Plan& plan, std::uint32_t episode);

// The index of an episode within its task.
inline int index_in_task(const plan::Plan& plan, std::uint32_t episode) {
  return static_cast<int>(plan.episodes()[episode].index);
}

}  // namespace probe::ask
