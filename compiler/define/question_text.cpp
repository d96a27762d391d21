#include "compiler/define/question_text.h"

#include <algorithm>

#include "compiler/define/question_pool.h"
#include "compiler/define/telling.h"
#include "runtime/base/nouns.h"
#include "runtime/plan/limits.h"

namespace probe::sema {

using plan::OmissionReason;

namespace {

std::string with_article(Placeholder::Article article, bool bare, std::string_view words) {
  if (bare || article == Placeholder::kBare) return std::string(words);
  if (article == Placeholder::kThe) return "the " + std::string(words);
  return with_indefinite_article(words);
}

}  // namespace

MayOmit QuestionText::say(const Placeholder& placeholder, std::string& out) {
  if (placeholder.kind == Placeholder::kInstruction) {
    // At the end a policy was told all of it, where all came.
    const Task& task = asked_.task();
    out = asked_.family().moment == plan::QuestionMoment::kEnd ? whole_prompt(task) : task.prompt;
    return {};
  }
  // What a judge answers may be asked of a part of a fixture.
  const QuestionAnswer::Kind answer = asked_.family().answer.kind;
  const bool is_judged =
      answer == QuestionAnswer::kMetric || answer == QuestionAnswer::kCondition;
  ObjectId id = ObjectId::kNone;
  if (auto why_not = is_judged && placeholder.kind == Placeholder::kName
                         ? referents_.resolve_any(placeholder.who, id)
                         : referents_.resolve(placeholder.who, id))
    return why_not;
  const Object& object = asked_.model().objects[id];
  if (object.of) {
    out = with_article(placeholder.article, object.bare, object.text.text);
    return referents_.check_name_of(id, placeholder.span);
  }
  if (placeholder.kind == Placeholder::kPhrase) {
    const Phrase* phrase = asked_.scene.phrase_for(id);
    if (phrase == nullptr) return OmissionReason::kPhraseIsName;
    out = with_article(placeholder.article, phrase->bare, phrase->text.text);
    return referents_.check_phrase_of(*phrase, id, placeholder.span);
  }
  if (placeholder.kind == Placeholder::kName) {
    // What is asked for may be missing; what is spoken of is there.
    const Family& family = asked_.family();
    const bool is_asked_for =
        family.answer.kind == QuestionAnswer::kPresent && placeholder.who == family.answer.who[0];
    if (!asked_.scene.body_of(id) && !is_asked_for) return OmissionReason::kNoMember;
    out = with_article(placeholder.article, object.bare, object.text.text);
    if (std::find(mentioned_.begin(), mentioned_.end(), id) == mentioned_.end())
      mentioned_.push_back(id);
    return is_asked_for ? MayOmit{} : referents_.check_name_of(id, placeholder.span);
  }
  const auto value = value_of(asked_.model(), placeholder.attribute, id);
  if (!value) return OmissionReason::kNotKnown;
  std::string words = asked_.model().attributes[placeholder.attribute].values[*value];
  std::replace(words.begin(), words.end(), '_', ' ');
  out = with_article(placeholder.article, false, words);
  return {};
}

MayOmit QuestionText::render() {
  const Family& family = asked_.family();
  for (const Family::Part& part : family.parts) {
    std::string words = part.literal;
    if (part.placeholder) {
      if (auto why_not = say(*part.placeholder, words)) return why_not;
    }
    text_ += words;
    const bool is_prompt = part.placeholder && part.placeholder->kind == Placeholder::kInstruction;
    own_ += is_prompt ? " " : words;
  }
  if (text_.size() > plan::kMaxStringBytes) {
    asked_.context.report(Situation::kTextTooLong, family.text_span,
                          asked_.here() + "it has " + std::to_string(text_.size()) +
                              " bytes, at most " + std::to_string(plan::kMaxStringBytes) +
                              " are kept");
  }
  return {};
}

}  // namespace probe::sema
