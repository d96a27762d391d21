#include "compiler/define/question_pool.h"

#include <algorithm>

#include "compiler/define/query.h"
#include "runtime/base/sha256.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {

std::optional<std::uint32_t> value_of(const Model& model, AttributeId attribute, ObjectId id) {
  if (attribute == AttributeId::kNone) return std::nullopt;
  const auto& values = model.objects[id].values[static_cast<std::size_t>(attribute)];
  if (values.size() != 1) return std::nullopt;
  return values[0];
}
Truth has_value(const Model& model, AttributeId attribute, std::uint32_t value, ObjectId id) {
  const auto& values = model.objects[id].values[static_cast<std::size_t>(attribute)];
  if (values.empty()) return Truth::kUnknown;
  return std::find(values.begin(), values.end(), value) != values.end() ? Truth::kYes : Truth::kNo;
}

PoolReader::PoolReader(const FamilyOfTask& asked)
    : asked_(asked),
      model_(asked.model()),
      scene_(asked.scene),
      set_(asked.set()),
      family_(asked.family()),
      text_(fold_case(asked.family().text)) {}

bool PoolReader::can_be_absent(ObjectId id, ObjectId bound) const {
  return scene_.is_absent(id) && !has_words(text_, scene_.name(id)) && !fits_description(id, bound);
}

// Who is meant, where that is one object.
ObjectId PoolReader::described_by(const Who& who, ObjectId bound) const {
  switch (who.kind) {
    case Who::kSource:
      return scene_.task().source;
    case Who::kTarget:
      return scene_.task().target;
    case Who::kAvoided:
      return scene_.avoided().size() == 1 ? scene_.avoided()[0] : ObjectId::kNone;
    case Who::kBound:
      return bound;
    case Who::kObject:
      return who.object;
    case Who::kRole:
      return scene_.filled_by(who.role);
  }
  return ObjectId::kNone;
}

// What the question says of its answer by an attribute.
bool PoolReader::fits_description(ObjectId id, ObjectId bound) const {
  for (const Family::Part& part : family_.parts) {
    if (!part.placeholder || part.placeholder->kind != Placeholder::kAttribute) continue;
    const Placeholder& said = *part.placeholder;
    const ObjectId described = described_by(said.who, bound);
    if (described == ObjectId::kNone) continue;
    const auto value = value_of(model_, said.attribute, described);
    if (value && has_value(model_, said.attribute, *value, id) != Truth::kNo) return true;
  }
  return false;
}

std::vector<ObjectId> PoolReader::drawn(std::string_view what,
                                        const std::vector<ObjectId>& from) const {
  std::vector<std::pair<Sha256, ObjectId>> draws;
  for (const ObjectId id : from) {
    Hasher hasher;
    hasher.text(what).text(set_.name).text(family_.name).text(scene_.task().name);
    draws.emplace_back(hasher.text(model_.objects[id].name).finish(), id);
  }
  std::sort(draws.begin(), draws.end());
  std::vector<ObjectId> out;
  for (const auto& [hash, id] : draws) out.push_back(id);
  return out;
}

std::vector<ObjectId> PoolReader::members(const QuestionPool& pool, ObjectId bound) const {
  std::vector<ObjectId> out = scene_.all();
  if (!pool.is_catalogue && pool.absent == 0) return out;
  std::vector<ObjectId> absent;
  for (std::size_t i = 0; i < model_.objects.size(); ++i) {
    if (can_be_absent(model_.objects.id(i), bound)) absent.push_back(model_.objects.id(i));
  }
  if (!pool.is_catalogue) absent = drawn("vlaprobe.absent", absent);
  for (const ObjectId id : absent) {
    if (!pool.is_catalogue && out.size() - scene_.all().size() >= pool.absent) break;
    const bool is_new = std::none_of(out.begin(), out.end(), [&](ObjectId other) {
      return scene_.names().are_alike(id, other);
    });
    if (is_new) out.push_back(id);
  }
  tell_fewer(pool, out.size() - scene_.all().size());
  return out;
}

void PoolReader::tell_fewer(const QuestionPool& pool, std::size_t absent) const {
  // A library wants what a small catalogue may not have.
  const auto& roots = asked_.context.roots;
  const bool is_root = std::find(roots.begin(), roots.end(), family_.span.file) != roots.end();
  if (!is_root || pool.is_catalogue || absent >= pool.absent) return;
  asked_.ambiguities.tell(Code::P0905, family_.span,
                          asked_.here() + std::to_string(pool.absent) +
                              " absent objects are wanted, and there " +
                              (absent == 1 ? "is " : "are ") + std::to_string(absent));
}

}  // namespace probe::sema
