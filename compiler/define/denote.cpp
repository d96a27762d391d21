#include "compiler/define/denote.h"

#include <algorithm>

#include "compiler/define/query.h"
#include "runtime/base/utf8.h"

namespace probe::sema {

Denotation denote(const Model& model, std::span<const ObjectId> objects, const Phrase& phrase,
                  ObjectId wanted) {
  Denotation found;
  const Truth own = evaluate(phrase.means, model.objects[wanted]);
  found.fits = own == Truth::kYes;
  found.may_fit = own != Truth::kNo;
  for (const ObjectId id : objects) {
    if (id == wanted) continue;
    const Truth truth = evaluate(phrase.means, model.objects[id]);
    if (truth == Truth::kYes) found.sure.push_back(id);
    if (truth == Truth::kUnknown) found.perhaps.push_back(id);
  }
  return found;
}

NameClash clash(std::string_view name, std::string_view other) {
  const std::string folded = fold_case(other), mine = fold_case(name);
  if (folded == mine) return NameClash::kSame;
  const bool is_part = folded.size() > mine.size() &&
                       (folded.starts_with(mine + " ") || folded.ends_with(" " + mine));
  return is_part ? NameClash::kPartOf : NameClash::kNone;
}

CategoryFit fits_category(const Model& model, const Object& object, std::string_view category) {
  const auto& attributes = model.attributes;
  const auto attribute = std::find_if(attributes.begin(), attributes.end(),
                                      [](const Attribute& a) { return a.name == "category"; });
  if (attribute == attributes.end()) return CategoryFit::kNoAttribute;
  const auto index = static_cast<std::size_t>(attribute - attributes.begin());
  const std::vector<std::uint32_t>& has = object.values[index];
  const bool fits = std::any_of(has.begin(), has.end(), [&](std::uint32_t value) {
    return attribute->values[value] == category;
  });
  return fits ? CategoryFit::kYes : CategoryFit::kNo;
}

}  // namespace probe::sema
