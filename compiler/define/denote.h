// Whether words mean the object that they are meant for, and it alone, among the objects of a task:
// what the checks ask of an instruction, `derive` of a phrase and a rewording of both.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

struct Denotation {
  bool fits = false;              // the phrase is true of the object it is meant for
  bool may_fit = false;           // or not known to be false
  std::vector<ObjectId> sure;     // others of which it is true
  std::vector<ObjectId> perhaps;  // others of which it is not known

  bool is_clear() const { return fits && sure.empty() && perhaps.empty(); }
};
// Of a phrase among the objects of a task, in their order. `objects` may hold `wanted`.
Denotation denote(const Model& model, std::span<const ObjectId> objects, const Phrase& phrase,
                  ObjectId wanted);

// Whether who says a name may mean what is called `other`. Words that differ in case alone are the
// same words.
enum class NameClash : std::uint8_t { kNone, kSame, kPartOf };
NameClash clash(std::string_view name, std::string_view other);

// Whether a slot that wants a category takes the object: `{source: drink}`.
enum class CategoryFit : std::uint8_t { kYes, kNo, kNoAttribute };
CategoryFit fits_category(const Model& model, const Object& object, std::string_view category);

}  // namespace probe::sema
