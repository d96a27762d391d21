// What an expression speaks of by name: roles, objects, the fixture.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// Each with the first place that does, in the order of the text.
struct Mentioned {
  std::map<RoleId, Span> roles;
  std::map<ObjectId, Span> objects;
  std::optional<Span> fixture;

  void add(const Mentioned& other);
};

// Of an expression with the predicates that it calls. `known` is filled on the way, so that what
// several expressions share is looked at once.
class MentionedIn {
 public:
  explicit MentionedIn(const Model& model) : model_(model) {}

  const Mentioned& expression(ExprRef ref);
  // Of all metrics of a task.
  const Mentioned& metrics(std::span<const Metric* const> metrics);

 private:
  void look(ExprRef ref, Mentioned& out);
  void look_at_set(SetRef ref, Mentioned& out);

  const Model& model_;
  std::map<ExprRef, Mentioned> known_;
  std::map<std::vector<ExprRef>, Mentioned> together_;  // many tasks are judged by the same
};

}  // namespace probe::sema
