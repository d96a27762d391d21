#include "compiler/define/ask_family.h"

#include <algorithm>

#include "compiler/define/option_words.h"
#include "compiler/define/right_answer.h"
#include "compiler/define/set.h"
#include "runtime/plan/family_name.h"

namespace probe::sema {
namespace {

using plan::OmissionReason;

class FamilyAsker {
 public:
  explicit FamilyAsker(const FamilyOfTask& asked)
      : asked_(asked),
        model_(asked.model()),
        scene_(asked.scene),
        family_(asked.family()),
        pools_(asked) {}

  // Nothing when at least one question came of it.
  MayOmit ask() {
    if (!family_.over) return ask_one(ObjectId::kNone);
    MayOmit reason = OmissionReason::kNoMember;
    bool is_asked = false;
    for (const ObjectId bound : pools_.members(*family_.over, ObjectId::kNone)) {
      const auto why_not = ask_one(bound);
      is_asked = is_asked || !why_not;
      if (why_not) reason = why_not;
    }
    return is_asked ? std::nullopt : reason;
  }

 private:
  MayOmit ask_one(ObjectId bound) {
    if (family_.where != syntax::CondId::kNone) {
      const SetReader conditions(asked_.context, SetReader::Mode::kDefined);
      if (!conditions.holds(*asked_.set().file, syntax::CondId{family_.where}, asked_.task()))
        return OmissionReason::kCondition;
    }
    const Referents referents(asked_, bound);
    QuestionText text(asked_, referents);
    if (auto why_not = text.render()) return why_not;
    AskedQuestion question;
    question.set = asked_.set_id;
    question.family = asked_.family_index;
    question.task = scene_.task_id();
    question.text = text.text();
    if (auto why_not = find_right_answer(asked_, referents, text, pools_, bound, question))
      return why_not;
    if (auto why_not = check_said_before(referents, question)) return why_not;
    // Things of one name can be counted; else an answer's name must tell them apart.
    if (family_.form != plan::QuestionForm::kNumber) {
      std::vector<ObjectId> named;
      for (const AskedOption& option : question.options) named.push_back(option.object);
      if (auto why_not = referents.check_options(named)) return why_not;
    }
    // A second object of the same name is asked about by the same words.
    for (const std::string& said : said_) {
      if (said == question.text) return OmissionReason::kNoMember;
    }
    said_.push_back(question.text);
    add_option_words(model_, scene_, question);
    asked_.context.model.asked.push_back(std::move(question));
    return {};
  }

  // What the right answer is, in words that compare: who is chosen, pointed at, left of whom.
  std::string right_of(const AskedQuestion& question) const {
    const auto name = [&](std::uint32_t option) {
      return option == plan::kNone ? std::string("-")
                                   : model_.objects[question.options[option].object].name;
    };
    const bool is_choice =
        family_of(question).form == plan::QuestionForm::kChoice && question.right != plan::kNone;
    return std::to_string(static_cast<int>(question.truth)) + " " + name(question.a) + " " +
           name(question.b) + " " +
           (is_choice ? name(question.right) : std::to_string(question.right));
  }
  const Family& family_of(const AskedQuestion& question) const {
    return model_.question_sets[question.set].families[question.family];
  }
  static bool offers(const AskedQuestion& question, ObjectId id) {
    return std::any_of(question.options.begin(), question.options.end(),
                       [&](const AskedOption& option) { return option.object == id; });
  }
  // The same words about the same picture, which the one calls right and the other wrong. Who asks
  // of a choice between other objects asks something else.
  MayOmit check_said_before(const Referents& referents, const AskedQuestion& question) const {
    for (auto other = model_.asked.rbegin();
         other != model_.asked.rend() && other->task == scene_.task_id(); ++other) {
      const Family& before = family_of(*other);
      if (&before == &family_ || other->text != question.text || before.form != family_.form ||
          before.moment != family_.moment)
        continue;
      if (question.judged || right_of(*other) == right_of(question)) continue;
      const bool is_choice = family_.form == plan::QuestionForm::kChoice;
      if (is_choice && (!offers(question, other->options[other->right].object) ||
                        !offers(*other, question.options[question.right].object)))
        continue;
      const std::string& set = model_.question_sets[other->set].name;
      return referents.ambiguous(family_.text_span,
                                 asked_.here() + "`" + plan::family_name(set, before.name) +
                                     "` asks by the same words and has another right answer");
    }
    return {};
  }

  const FamilyOfTask& asked_;
  const Model& model_;
  const SceneObjects& scene_;
  const Family& family_;
  PoolReader pools_;
  std::vector<std::string> said_;
};

}  // namespace

MayOmit ask_family(const FamilyOfTask& asked) { return FamilyAsker(asked).ask(); }

}  // namespace probe::sema
