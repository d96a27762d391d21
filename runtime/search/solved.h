// What the expert solves, by which a start is fair or not.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/run/run.h"
#include "runtime/search/points_file.h"

namespace probe::search {

// How a row's episode ended; nothing where that counts neither way.
std::optional<bool> success_of(const store::ResultRow& row);

// Whether the expert solves a start of the base task where things lie as a point has them: known
// once for all points that agree in that.
class Solved {
 public:
  // `options`: of runs of the expert, each into a folder of its own.
  Solved(const BaseTask& base, run::RunOptions options)
      : base_(base), options_(std::move(options)) {}
  // A round in `folder`: what the runs there have found is known.
  Status begin(const PlannedPoints& planned, const std::string& folder);

  struct Question {
    std::size_t point = kBase;  // of the plan's points, one that proves others
    std::uint32_t start = 0;    // of the base task's
  };
  // Runs the expert where it is not known yet. What is asked must be in one plan.
  Status find_out(const PlannedPoints& planned, std::span<const Question> questions);
  // Of what was found out; nothing where the expert has no skills for it.
  std::optional<bool> is_solved(const PlannedPoints& planned, const Question& question) const;

  int known() const { return static_cast<int>(known_.size()); }
  int unsolved() const;
  int not_attempted() const;

 private:
  // Placed values, what was drawn for them, start.
  using Key = std::tuple<std::vector<double>, std::uint64_t, std::uint32_t>;
  enum class Answer : std::uint8_t { kYes, kNo, kNoSkill };
  Key key_of(const PlannedPoints& planned, const Question& question) const;
  void keep(const PlannedPoints& planned, const store::ResultRow& row);

  const BaseTask& base_;
  run::RunOptions options_;
  std::string folder_;
  int folders_ = 0;
  std::map<Key, Answer> known_;
};

}  // namespace probe::search
