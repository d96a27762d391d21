// What a task says and what it is judged by, read when some word asks for it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/check/goal_words.h"
#include "compiler/check/said.h"
#include "compiler/check/shared.h"
#include "compiler/model/model.h"

namespace probe::sema {

class Told {
 public:
  Told(const Model& model, const Task& task, Shared& shared)
      : model_(model), task_(task), shared_(shared), text_(shared.text(task.say)) {}

  const Model& model() const { return model_; }
  const Task& task() const { return task_; }
  const Said& said() {
    if (said_ == nullptr) said_ = &shared_.said(task_);
    return *said_;
  }
  const Goal& goal() {
    if (goal_ == nullptr) goal_ = &shared_.goal(task_);
    return *goal_;
  }
  const Clauses& clauses() {
    if (clauses_ == nullptr) clauses_ = &shared_.clauses(task_);
    return *clauses_;
  }

  // By what it is filled with: alike tasks have equal ones.
  const Shared::ClauseKey& key() {
    if (!key_) key_ = shared_.clause_key(task_);
    return *key_;
  }

  // Those of the table that are said.
  const std::vector<GoalWords>& words() const { return text_.words; }

  // Whether words that ask so tell to do it.
  bool says(Asks asks);
  // Words that tell to do so, not how a thing is: "open the drawer", not "the open drawer", "left
  // open" or "close to".
  bool tells_to(const GoalWords& one);
  // "Pick up the bowl between A and B": that says which bowl, not where to.
  bool tells_which(std::size_t at);
  // Whether success asks anything of one of these.
  bool is_asked(const Things& things);
  // Where one of these is spoken of first.
  std::optional<std::size_t> earliest(const Things& things);
  std::string name_of(const Things& things) const;

 private:
  const Model& model_;
  const Task& task_;
  Shared& shared_;
  const Shared::Text& text_;
  const Said* said_ = nullptr;
  const Goal* goal_ = nullptr;
  const Clauses* clauses_ = nullptr;
  std::optional<Shared::ClauseKey> key_;
};

}  // namespace probe::sema
