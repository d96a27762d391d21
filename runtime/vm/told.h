// Which sentence of its instruction a task says, step by step: the conditions of later ones are judged
// after each control step from the first on, and one that holds while the sentence before it is said
// brings its own with the next observation. At most one comes in a step.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/vm/judge.h"

namespace probe::vm {

// Of no meaning to another task.
struct ToldState {
  std::uint32_t sentence = 0;
  std::vector<JudgeState> conditions;
};

class Told {
 public:
  // Of most tasks: one sentence, and nothing to judge. Keeps no reference to the plan.
  Told(const plan::Plan& plan, std::uint32_t task);

  // As of a Judge; failures have kJudge.
  Status begin(std::span<const BodyStart> starts);
  Status step(const StepSample& sample);
  ToldState save() const;
  Status restore(std::span<const BodyStart> starts, const ToldState& state);

  // Said with the next observation: 0 the first.
  std::uint32_t sentence() const { return sentence_; }
  const std::string& text() const { return sentences_[sentence_]; }
  std::size_t count() const { return sentences_.size(); }
  const std::string& text(std::size_t sentence) const { return sentences_[sentence]; }

 private:
  std::vector<std::string> sentences_;
  std::vector<Judge> conditions_;  // of the second sentence and those behind it
  std::uint32_t sentence_ = 0;
};

}  // namespace probe::vm
