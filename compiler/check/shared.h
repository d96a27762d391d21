// What tasks that say or are judged by the same have in common, read once. A check of thousands of
// tasks, and of each keystroke, lives on it.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/check/called.h"
#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/check/goal_words.h"
#include "compiler/check/said.h"
#include "compiler/model/model.h"

namespace probe::sema {

using PartOf = std::pair<FixtureId, std::uint32_t>;

class Shared {
 public:
  explicit Shared(const Model& model) : model_(model), callings_(model) {}

  using Filled = std::vector<std::uint32_t>;  // by role: how many, and which

  struct Text {
    std::string folded;
    std::vector<GoalWords> words;  // those of the table that are said
  };
  const Text& text(TemplateId say);
  // What success is, as expressions.
  static std::vector<ExprRef> success_of(const Task& task);
  const std::set<PredicateId>& relations(const std::vector<ExprRef>& success);
  const std::set<PartOf>& parts(const std::vector<ExprRef>& success);
  // What the metrics ask, of tasks that are judged by the same and whose roles the same fills.
  const Goal& goal(const Task& task);
  // What an instruction says, of tasks that say the same of the same where the same stands.
  const Said& said(const Task& task);
  const Clauses& clauses(const Task& task);

  // Words and success of which nothing was to be said, of tasks whose roles are filled alike: each
  // by as many objects, by the same parts; by the same objects where expressions name some.
  using ClauseKey = std::tuple<TemplateId, std::vector<ExprRef>, Filled>;
  ClauseKey clause_key(const Task& task) const;
  bool has_right_relations(const ClauseKey& key) const { return right_relations_.contains(key); }
  void keep_right_relations(const ClauseKey& key) { right_relations_.insert(key); }
  bool has_right_clauses(const ClauseKey& key) const { return right_clauses_.contains(key); }
  void keep_right_clauses(const ClauseKey& key) { right_clauses_.insert(key); }

 private:
  using Judged = std::tuple<bool, ExprRef, plan::Readout>;
  using HeardKey = std::tuple<TemplateId, Filled, std::vector<ObjectId>>;

  // The scene with who fills the roles: `parts` are those of its fixtures. `is_told`: of which
  // objects it matters who they are.
  template <typename IsTold>
  Filled filled(const Task& task, IsTold is_told) const;
  HeardKey heard_key(const Task& task) const;

  const Model& model_;
  Callings callings_;
  std::map<TemplateId, Text> texts_;
  std::map<std::pair<std::vector<Judged>, Filled>, Goal> goals_;
  std::map<HeardKey, Said> said_;
  std::map<HeardKey, Clauses> clauses_;
  std::map<std::vector<ExprRef>, std::set<PredicateId>> relations_;
  std::map<std::vector<ExprRef>, std::set<PartOf>> parts_;
  std::set<ClauseKey> right_relations_, right_clauses_;
};

}  // namespace probe::sema
