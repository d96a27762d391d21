// P1202 of phrases: words that say where things are must be those of the relation that proves them.
#include <algorithm>
#include <set>

#include "compiler/check/check.h"
#include "compiler/check/relation_words.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// Whether words behind the relation's speak of the object: by the last word of its name, or by a
// phrase of it.
bool speaks_of(std::string_view text, const Predicate& relation, const Object& object) {
  std::size_t behind = text.size();
  for (const std::string& words : relation.words) {
    const std::size_t at = text.find(words);
    if (at != text.npos) behind = std::min(behind, at + words.size());
  }
  const std::string_view rest = text.substr(behind);
  const std::string name = fold_case(object.text.text);
  if (has_words(rest, std::string_view(name).substr(name.rfind(' ') + 1))) return true;
  return std::any_of(object.phrases.begin(), object.phrases.end(), [&](const Phrase& phrase) {
    return has_words(rest, fold_case(phrase.text.text));
  });
}

}  // namespace

void check_spatial_words(const Model& model, Reporter& reporter) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> said;  // objects are copied with their phrases
  for (const Object& object : model.objects) {
    for (const Phrase& phrase : object.phrases) {
      const std::string text = fold_case(phrase.text.text);
      for (const QueryOp& op : phrase.means) {
        if (op.kind != QueryOp::kRelation) continue;
        const Predicate& relation = model.predicates[static_cast<PredicateId>(op.a)];
        if (relation.broken) continue;
        const Span& span = phrase.text.span;
        const About about(reporter, object.decl_span);
        if (says(text, relation)) {
          for (const ObjectId other : op.to) {
            if (other == ObjectId::kNone || speaks_of(text, relation, model.objects[other]))
              continue;
            if (!said.insert({span.file.value, span.begin}).second) continue;
            reporter
                .report(Code::P1202, span,
                        "\"" + phrase.text.text + "\" does not say to which object: `" +
                            model.objects[other].name + "`")
                .point("`" + relation.name + "` is to \"" + model.objects[other].text.text + "\"");
          }
          continue;
        }
        if (!said.insert({span.file.value, span.begin}).second) continue;
        reporter
            .report(Code::P1202, span,
                    "\"" + phrase.text.text + "\" does not say `" + relation.name + "`")
            .point("it is said by " + listed(relation.words))
            .label(relation.span, "declared here");
      }
    }
  }
}

}  // namespace probe::sema
