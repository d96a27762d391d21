// The objects that a question is about or lets choose from: those of the scene, and some of the
// catalogue that are certainly not there, which are drawn by hashes of names, so that another task
// or family changes nothing.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/define/family_of_task.h"

namespace probe::sema {

class PoolReader {
 public:
  explicit PoolReader(const FamilyOfTask& asked);  // which outlives it

  // Whether an object is certainly not in the scene, whatever it is called and shown as, nor fits
  // what the question says of its answer. `bound`: what `for` binds.
  bool can_be_absent(ObjectId id, ObjectId bound) const;

  // Those of the scene first, in its order. Fewer than asked for when there are no more, which is
  // told once of a family.
  std::vector<ObjectId> members(const QuestionPool& pool, ObjectId bound) const;

  // In an order of their own, by `what` it is for.
  std::vector<ObjectId> drawn(std::string_view what, const std::vector<ObjectId>& from) const;

 private:
  ObjectId described_by(const Who& who, ObjectId bound) const;
  bool fits_description(ObjectId id, ObjectId bound) const;

  void tell_fewer(const QuestionPool& pool, std::size_t absent) const;

  const FamilyOfTask& asked_;
  const Model& model_;
  const SceneObjects& scene_;
  const QuestionSet& set_;
  const Family& family_;
  std::string text_;  // folded
};

// An object's only value of an attribute; nothing where it has none, or several.
std::optional<std::uint32_t> value_of(const Model& model, AttributeId attribute, ObjectId id);
// Whether it is among the object's values; unknown where it has none.
Truth has_value(const Model& model, AttributeId attribute, std::uint32_t value, ObjectId id);

}  // namespace probe::sema
