#include "compiler/define/referents.h"

#include <algorithm>

#include "compiler/define/likeness.h"
#include "compiler/define/query.h"
#include "compiler/define/question_pool.h"
#include "runtime/base/words.h"

namespace probe::sema {

using plan::OmissionReason;

bool Referents::asks_for_more() const {
  return std::any_of(task_.others.begin(), task_.others.end(), [&](const Task::Filled& filled) {
    return std::any_of(filled.objects.begin(), filled.objects.end(),
                       [&](ObjectId id) { return scene_.is_told(id); });
  });
}

MayOmit Referents::resolve(const Who& who, ObjectId& out) const {
  const MayOmit why_not = resolve_any(who, out);
  // A part is in the scene as what it belongs to is: questions about objects pass it over.
  if (!why_not && out != ObjectId::kNone && !task_.is_object(out)) return OmissionReason::kNoMember;
  return why_not;
}

MayOmit Referents::resolve_any(const Who& who, ObjectId& out) const {
  switch (who.kind) {
    case Who::kSource:
      out = task_.source;
      return out == ObjectId::kNone ? MayOmit(OmissionReason::kNoMember) : MayOmit();
    case Who::kTarget:
      out = task_.target;
      return out == ObjectId::kNone ? MayOmit(OmissionReason::kNoMember) : MayOmit();
    case Who::kAvoided:
      if (scene_.avoided().empty()) return OmissionReason::kNothingToAvoid;
      if (scene_.avoided().size() > 1)
        return ambiguous(who.span, "the instruction of `" + task_.name + "` tells of " +
                                       std::to_string(scene_.avoided().size()) +
                                       " objects to leave alone");
      out = scene_.avoided()[0];
      return {};
    case Who::kBound:
      out = bound_;
      return {};
    case Who::kObject:
      out = who.object;
      return {};
    case Who::kRole:
      out = scene_.filled_by(who.role);
      return out == ObjectId::kNone ? MayOmit(OmissionReason::kNoMember) : MayOmit();
  }
  return OmissionReason::kNoMember;
}

MayOmit Referents::resolve_there(const Who& who, ObjectId& out) const {
  if (auto why_not = resolve(who, out)) return why_not;
  if (!scene_.body_of(out)) return OmissionReason::kNoMember;
  return {};
}

OmissionReason Referents::ambiguous(const Span& span, const std::string& message) const {
  return asked_.ambiguities.report(Code::P0901, span, set_.allow_ambiguous, message, "ambiguous");
}

MayOmit Referents::check_name_of(ObjectId id, const Span& span) const {
  for (const ObjectId other : objects_) {
    if (other == id || !is_part_of_name(scene_.name(id), scene_.name(other))) continue;
    return ambiguous(span, here() + "\"" + model_.objects[id].text.text + "\" may also mean `" +
                               model_.objects[other].name + "`");
  }
  return check_looks_of(id, model_.objects[id].text.text, span);
}

MayOmit Referents::check_looks_of(ObjectId id, const std::string& words, const Span& span) const {
  for (const ObjectId other : objects_) {
    if (other == id || !look_alike(model_, id, other)) continue;
    return ambiguous(span, here() + "`" + model_.objects[other].name + "` looks as `" +
                               model_.objects[id].name + "` does: \"" + words + "\" may be either");
  }
  return {};
}

MayOmit Referents::check_phrase_of(const Phrase& phrase, ObjectId id, const Span& span) const {
  if (phrase.is_spatial()) return check_places_of(phrase, id, span);
  for (const ObjectId other : objects_) {
    if (other == id) continue;
    const Truth truth = evaluate(phrase.means, model_.objects[other]);
    if (truth == Truth::kNo) continue;
    // A second referent of an instruction is told of the task (P0402, P0403).
    if (scene_.is_slot(id)) return OmissionReason::kAmbiguous;
    return ambiguous(span, here() + "\"" + phrase.text.text + "\" " +
                               (truth == Truth::kYes ? "denotes `" : "may denote `") +
                               model_.objects[other].name + "`, too");
  }
  return check_looks_of(id, phrase.text.text, span);
}

// Of words that say where things are: they must in every start.
MayOmit Referents::check_places_of(const Phrase& phrase, ObjectId id, const Span& span) const {
  for (std::size_t i = 0; i < task_.starts.size(); ++i) {
    if (InStart(asked_.relations, task_, task_.starts[i]).denote(phrase, id).is_clear()) continue;
    // As of an instruction's second referent.
    if (scene_.is_slot(id)) return OmissionReason::kAmbiguous;
    return ambiguous(
        span, here() + "\"" + phrase.text.text + "\" is not clear in start " + std::to_string(i));
  }
  return {};
}

// The words of the instruction for an object.
MayOmit Referents::check_told(ObjectId id, const Span& span) const {
  if (const Phrase* phrase = scene_.phrase_for(id)) return check_phrase_of(*phrase, id, span);
  return check_name_of(id, span);
}

MayOmit Referents::check_role(const Who& who, ObjectId id) const {
  if (who.kind == Who::kAvoided) return check_name_of(id, family_.answer.span);
  if (scene_.is_avoided(id)) return OmissionReason::kAvoidsIt;
  if (!scene_.is_told(id)) return OmissionReason::kNotTold;
  if (who.kind == Who::kSource && asks_for_more()) return OmissionReason::kAmbiguous;
  return check_told(id, family_.answer.span);
}

MayOmit Referents::check_attributes(ObjectId right) const {
  for (const Family::Part& part : family_.parts) {
    if (!part.placeholder || part.placeholder->kind != Placeholder::kAttribute ||
        !(part.placeholder->who == family_.answer.who[0]))
      continue;
    const Placeholder& said = *part.placeholder;
    const auto value = value_of(model_, said.attribute, right);
    for (const ObjectId other : objects_) {
      if (!value || other == right ||
          has_value(model_, said.attribute, *value, other) == Truth::kNo)
        continue;
      return ambiguous(said.span, here() + "`" + model_.attributes[said.attribute].name + " " +
                                      model_.attributes[said.attribute].values[*value] +
                                      "` may hold for `" + model_.objects[other].name + "`, too");
    }
  }
  return {};
}

MayOmit Referents::check_options(const std::vector<ObjectId>& options) const {
  std::vector<std::string_view> names;
  for (const ObjectId id : options) names.push_back(scene_.name(id));
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return {};
  return asked_.ambiguities.report(
      Code::P0902, family_.span, set_.allow_same,
      here() + "two options are called \"" + std::string(*twice) + "\"", "same_options");
}

}  // namespace probe::sema
