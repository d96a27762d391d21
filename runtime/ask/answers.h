// A folder of answers: answers.sqlite, suite.plan, lock. Each answer is stored exactly once; rows
// are written in transactions of many by a thread of their own, so that no asker waits for the
// disk: what a kill takes is asked again.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/ask/ask_record.h"
#include "runtime/ask/reading/answer_row.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

// What tells the answers about one start apart.
struct AnswerKey {
  std::string question_id;
  std::uint32_t rotation = 0;
  Arm arm = Arm::kPicture;
  int episode = 0;
  int seed = -1;
  auto operator<=>(const AnswerKey&) const = default;
};
inline AnswerKey key_of(const AnswerRow& row) {
  return {row.question_id, row.rotation, row.arm, row.episode, row.seed};
}

// A question that was not asked of a picture.
struct LeftOut {
  std::string question_id, start_id;
  int episode = 0, seed = -1;
  std::string set, family, task, why;
  bool operator==(const LeftOut&) const = default;
};

// The writer of a folder; one process writes one at a time. Any thread may call anything.
class Answers {
 public:
  // Makes the folder or continues it, whatever the build. Fails (kStore) when it cannot be
  // written, another process writes it, or it holds a run, or answers of another identity or
  // content; the message says which part differs.
  static Result<std::unique_ptr<Answers>> open(const std::string& dir, const AskRecord& record,
                                               std::span<const std::byte> plan_bytes);
  virtual ~Answers() = default;

  // Valid answers about this start that are stored, ascending; those of kPicture and rotation 0
  // alone of questions that were left out.
  struct Stored {
    std::vector<AnswerKey> answers, left_out;
    bool has(const AnswerKey& key) const;  // answered, or left out in any arm and rotation
  };
  virtual Result<Stored> stored(const std::string& start_id) = 0;
  // The rows of those answers, in the same order.
  virtual Result<std::vector<AnswerRow>> rows(const std::string& start_id) = 0;

  // Writes the row before long, replacing an invalid one of the same key. `place` sorts rows: the
  // question's index in the plan. Fails with whatever an earlier row could not be written for.
  virtual Status commit(const AnswerRow& row, std::uint32_t place) = 0;
  virtual Status leave_out(const LeftOut& left_out, std::uint32_t place) = 0;
  // Waits until all of it is on the disk.
  virtual Status flush() = 0;

  // What this call has done so far; each write replaces the one before.
  virtual Status write_call(const AskCall& call) = 0;
  // A call of another folder, whose rows come here.
  virtual Status add_call(const AskCall& call) = 0;
};

// Whether `dir` is a folder of answers, as its answers.sqlite says; whole or not.
using probe::holds_answers;
// Nothing when none was begun in `dir`.
Result<std::optional<AskRecord>> find_ask_record(const std::string& dir);
Result<AskRecord> read_ask_record(const std::string& dir);
Result<std::vector<AskCall>> read_ask_calls(const std::string& dir);
// The plan that was asked, believed only if it is the record's.
Result<plan::Plan> open_asked_plan(const std::string& dir);

// Every row, one at a time, by question in the plan's order, then start's index, seed, arm and
// rotation; `place` is the question's index. A damaged row is told as invalid. Ends with the first
// failure of `visit`.
Status for_each_answer(const std::string& dir,
                       const std::function<Status(AnswerRow row, std::uint32_t place)>& visit);
Result<std::vector<AnswerRow>> read_answers(const std::string& dir);
Status for_each_left_out(const std::string& dir,
                         const std::function<Status(LeftOut left_out, std::uint32_t place)>& visit);

}  // namespace probe::ask
