#include "compiler/define/ask_family.h"

#include <algorithm>

#include "compiler/define/option_words.h"
#include "compiler/define/query.h"
#include "compiler/define/question_pool.h"
#include "compiler/define/set.h"
#include "compiler/model/mentioned.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

using plan::OmissionReason;

// Asks one family of one task.
class FamilyAsker {
 public:
  FamilyAsker(Context& context, Ambiguities& ambiguities, Relations& relations,
              const SceneObjects& scene, QuestionSetId set_id, std::uint32_t family)
      : context_(context),
        ambiguities_(ambiguities),
        relations_(relations),
        model_(context.model),
        scene_(scene),
        set_id_(set_id),
        set_(model_.question_sets[set_id]),
        family_index_(family),
        family_(set_.families[family]),
        task_(scene.task()),
        objects_(scene.all()),
        pools_(model_, scene, set_, family_) {}

  // Nothing when at least one question came of it.
  std::optional<OmissionReason> ask() {
    if (!family_.over) return ask_one(ObjectId::kNone);
    std::optional<OmissionReason> reason = OmissionReason::kNoMember;
    bool asked = false;
    for (const ObjectId bound : members_of(*family_.over)) {
      const auto why_not = ask_one(bound);
      asked = asked || !why_not;
      if (why_not) reason = why_not;
    }
    return asked ? std::nullopt : reason;
  }

 private:
  using MayOmit = std::optional<OmissionReason>;

  // Whether the instruction speaks of what fills another role than source and target: then these
  // two are not all that it asks for.
  bool asks_for_more() const {
    return std::any_of(task_.others.begin(), task_.others.end(), [&](const Task::Filled& filled) {
      return std::any_of(filled.objects.begin(), filled.objects.end(),
                         [&](ObjectId id) { return scene_.is_told(id); });
    });
  }

  // Who is meant in this task.
  MayOmit resolve(const Who& who, ObjectId& out) {
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
  // The same for what has to be in the scene.
  MayOmit resolve_there(const Who& who, ObjectId& out) {
    if (auto why_not = resolve(who, out)) return why_not;
    if (!scene_.body_of(out)) return OmissionReason::kNoMember;
    return {};
  }

  // ---- what leaves open which object is meant

  OmissionReason ambiguous(const Span& span, const std::string& message) {
    return ambiguities_.report(Code::P0901, span, set_.allow_ambiguous, message, "ambiguous");
  }
  std::string here() const { return "in `" + task_.name + "`, question `" + family_.name + "`: "; }

  MayOmit check_name_of(ObjectId id, const Span& span) {
    for (const ObjectId other : objects_) {
      if (other == id || !is_part_of_name(scene_.name(id), scene_.name(other))) continue;
      return ambiguous(span, here() + "\"" + model_.objects[id].text.text + "\" may also mean `" +
                                 model_.objects[other].name + "`");
    }
    return {};
  }
  MayOmit check_phrase_of(const Phrase& phrase, ObjectId id, const Span& span) {
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
    return {};
  }
  // Of words that say where things are: they must in every start.
  MayOmit check_places_of(const Phrase& phrase, ObjectId id, const Span& span) {
    for (std::size_t i = 0; i < task_.starts.size(); ++i) {
      if (InStart(relations_, task_, task_.starts[i]).denote(phrase, id).is_clear()) continue;
      // As of an instruction's second referent.
      if (scene_.is_slot(id)) return OmissionReason::kAmbiguous;
      return ambiguous(
          span, here() + "\"" + phrase.text.text + "\" is not clear in start " + std::to_string(i));
    }
    return {};
  }
  // The words of the instruction for an object.
  MayOmit check_told(ObjectId id, const Span& span) {
    if (const Phrase* phrase = scene_.phrase_for(id)) return check_phrase_of(*phrase, id, span);
    return check_name_of(id, span);
  }

  // ---- words

  static std::string with_article(Placeholder::Article article, bool bare, std::string_view words) {
    if (bare || article == Placeholder::kBare) return std::string(words);
    if (article == Placeholder::kThe) return "the " + std::string(words);
    const bool vowel = std::string_view("aeiouAEIOU").find(words[0]) != std::string_view::npos;
    return (vowel ? "an " : "a ") + std::string(words);
  }

  MayOmit say(const Placeholder& placeholder, std::string& out) {
    if (placeholder.kind == Placeholder::kInstruction) {
      out = task_.prompt;
      return {};
    }
    ObjectId id = ObjectId::kNone;
    if (auto why_not = resolve(placeholder.who, id)) return why_not;
    const Object& object = model_.objects[id];
    if (placeholder.kind == Placeholder::kPhrase) {
      const Phrase* phrase = scene_.phrase_for(id);
      if (phrase == nullptr) return OmissionReason::kPhraseIsName;
      out = with_article(placeholder.article, phrase->bare, phrase->text.text);
      return check_phrase_of(*phrase, id, placeholder.span);
    }
    if (placeholder.kind == Placeholder::kName) {
      // What is asked for may be missing; what is spoken of is there.
      const bool is_asked_for = family_.answer.kind == QuestionAnswer::kPresent &&
                                placeholder.who == family_.answer.who[0];
      if (!scene_.body_of(id) && !is_asked_for) return OmissionReason::kNoMember;
      out = with_article(placeholder.article, object.bare, object.text.text);
      mention(id);
      return is_asked_for ? MayOmit{} : check_name_of(id, placeholder.span);
    }
    const auto value = value_of(model_, placeholder.attribute, id);
    if (!value) return OmissionReason::kNotKnown;
    std::string words = model_.attributes[placeholder.attribute].values[*value];
    std::replace(words.begin(), words.end(), '_', ' ');
    out = with_article(placeholder.article, false, words);
    return {};
  }

  // The text in full; `own_` without the instruction.
  MayOmit render() {
    text_.clear();
    own_.clear();
    for (const Family::Part& part : family_.parts) {
      std::string words = part.literal;
      if (part.placeholder) {
        if (auto why_not = say(*part.placeholder, words)) return why_not;
      }
      text_ += words;
      const bool is_prompt =
          part.placeholder && part.placeholder->kind == Placeholder::kInstruction;
      own_ += is_prompt ? " " : words;
    }
    if (text_.size() > plan::kMaxStringBytes) {
      context_.report(Situation::kTextTooLong, family_.text_span,
                      here() + "it has " + std::to_string(text_.size()) + " bytes, at most " +
                          std::to_string(plan::kMaxStringBytes) + " are kept");
    }
    return {};
  }

  // Tells once of a family that it gets fewer that are not there than it wants.
  std::vector<ObjectId> members_of(const QuestionPool& pool) {
    std::vector<ObjectId> members = pools_.members(pool, bound_);
    const std::uint64_t absent = members.size() - objects_.size();
    // A library wants what a small catalogue may not have.
    const bool is_root = std::find(context_.roots.begin(), context_.roots.end(),
                                   family_.span.file) != context_.roots.end();
    if (is_root && !pool.is_catalogue && absent < pool.absent) {
      ambiguities_.tell(Code::P0905, family_.span,
                        here() + std::to_string(pool.absent) +
                            " absent objects are wanted, and there " +
                            (absent == 1 ? "is " : "are ") + std::to_string(absent));
    }
    return members;
  }

  // ---- the question

  MayOmit ask_one(ObjectId bound) {
    bound_ = bound;
    mentioned_.clear();
    question_ = {};
    if (family_.where != syntax::CondId::kNone) {
      const SetReader conditions(context_, SetReader::Mode::kDefined);
      if (!conditions.holds(*set_.file, syntax::CondId{family_.where}, task_))
        return OmissionReason::kCondition;
    }
    if (auto why_not = render()) return why_not;
    if (auto why_not = answer()) return why_not;
    if (auto why_not = check_said_before()) return why_not;
    // Things of one name can be counted; else an answer's name must tell them apart.
    if (family_.form != plan::QuestionForm::kNumber) {
      std::vector<ObjectId> named;
      for (const AskedOption& option : question_.options) named.push_back(option.object);
      if (auto why_not = check_options(named)) return why_not;
    }
    // A second object of the same name is asked about by the same words.
    for (const std::string& text : said_) {
      if (text == text_) return OmissionReason::kNoMember;
    }
    said_.push_back(text_);
    question_.set = set_id_;
    question_.family = family_index_;
    question_.task = scene_.task_id();
    question_.text = text_;
    add_option_words(model_, scene_, question_);
    context_.model.asked.push_back(std::move(question_));
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
  MayOmit check_said_before() {
    for (auto other = model_.asked.rbegin();
         other != model_.asked.rend() && other->task == scene_.task_id(); ++other) {
      const Family& before = family_of(*other);
      if (&before == &family_ || other->text != text_ || before.form != family_.form ||
          before.moment != family_.moment)
        continue;
      question_.set = set_id_;
      question_.family = family_index_;
      if (question_.truth == plan::QuestionTruth::kRecorded ||
          right_of(*other) == right_of(question_))
        continue;
      const bool is_choice = family_.form == plan::QuestionForm::kChoice;
      if (is_choice && (!offers(question_, other->options[other->right].object) ||
                        !offers(*other, question_.options[question_.right].object)))
        continue;
      return ambiguous(family_.text_span, here() + "`" + model_.question_sets[other->set].name +
                                              "." + before.name +
                                              "` asks by the same words and has another right "
                                              "answer");
    }
    return {};
  }

  MayOmit answer() {
    switch (family_.answer.kind) {
      case QuestionAnswer::kOne:
        return family_.form == plan::QuestionForm::kChoice ? choice() : point();
      case QuestionAnswer::kPresent:
        return present();
      case QuestionAnswer::kLeft:
      case QuestionAnswer::kNearer:
        return beside();
      case QuestionAnswer::kCount:
        return count();
      case QuestionAnswer::kMentions:
        return mentions();
      case QuestionAnswer::kMetric:
      case QuestionAnswer::kCondition:
        return recorded();
    }
    return OmissionReason::kNoMember;
  }

  std::uint32_t add_option(ObjectId id, bool must_be_seen) {
    auto& options = question_.options;
    for (std::size_t i = 0; i < options.size(); ++i) {
      if (options[i].object != id) continue;
      options[i].must_be_seen = options[i].must_be_seen || must_be_seen;
      return static_cast<std::uint32_t>(i);
    }
    options.push_back({id, scene_.body_of(id), must_be_seen && scene_.body_of(id), {}});
    return static_cast<std::uint32_t>(options.size() - 1);
  }
  void mention(ObjectId id) {
    if (std::find(mentioned_.begin(), mentioned_.end(), id) == mentioned_.end())
      mentioned_.push_back(id);
  }

  bool says_instruction() const {
    return std::any_of(family_.parts.begin(), family_.parts.end(), [](const Family::Part& part) {
      return part.placeholder && part.placeholder->kind == Placeholder::kInstruction;
    });
  }

  // That the instruction asks for this object and for no other.
  MayOmit check_role(const Who& who, ObjectId id) {
    if (who.kind == Who::kAvoided) return check_name_of(id, family_.answer.span);
    if (scene_.is_avoided(id)) return OmissionReason::kAvoidsIt;
    if (!scene_.is_told(id)) return OmissionReason::kNotTold;
    if (who.kind == Who::kSource && asks_for_more()) return OmissionReason::kAmbiguous;
    return check_told(id, family_.answer.span);
  }

  MayOmit choice() {
    ObjectId right = ObjectId::kNone;
    if (auto why_not = resolve_there(family_.answer.who[0], right)) return why_not;
    if (says_instruction()) {
      if (auto why_not = check_role(family_.answer.who[0], right)) return why_not;
    }
    if (auto why_not = check_attributes(right)) return why_not;
    if (has_words(fold_case(own_), scene_.name(right))) return OmissionReason::kShowsAnswer;
    const std::vector<ObjectId> options =
        pools_.drawn("vlaprobe.order", members_of(*family_.among));
    if (options.size() < 2) return OmissionReason::kOneOption;
    if (options.size() > plan::kMaxOptions) {
      context_.report(Situation::kTooManyOptions, family_.answer.span,
                      here() + "expected at most " + std::to_string(plan::kMaxOptions) +
                          " options, found " + std::to_string(options.size()));
      return OmissionReason::kAmbiguous;
    }
    if (auto why_not = check_options(options)) return why_not;
    for (const ObjectId id : options) add_option(id, id == right);
    question_.right = static_cast<std::uint32_t>(std::find(options.begin(), options.end(), right) -
                                                 options.begin());
    return {};
  }
  // What is described by an attribute is described alone.
  MayOmit check_attributes(ObjectId right) {
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
  MayOmit check_options(const std::vector<ObjectId>& options) {
    std::vector<std::string_view> names;
    for (const ObjectId id : options) names.push_back(scene_.name(id));
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice == names.end()) return {};
    return ambiguities_.report(Code::P0902, family_.span, set_.allow_same,
                               here() + "two options are called \"" + std::string(*twice) + "\"",
                               "same_options");
  }

  MayOmit point() {
    ObjectId id = ObjectId::kNone;
    if (auto why_not = resolve_there(family_.answer.who[0], id)) return why_not;
    if (says_instruction()) {
      if (auto why_not = check_role(family_.answer.who[0], id)) return why_not;
    }
    question_.truth = plan::QuestionTruth::kPixelsOf;
    question_.a = add_option(id, true);
    return {};
  }

  MayOmit present() {
    ObjectId id = ObjectId::kNone;
    if (auto why_not = resolve(family_.answer.who[0], id)) return why_not;
    if (!scene_.body_of(id) && !pools_.can_be_absent(id, bound_)) {
      for (const ObjectId other : objects_) {
        if (scene_.names().are_alike(id, other))
          return ambiguous(family_.answer.span, here() + "`" + model_.objects[other].name +
                                                    "` may count as \"" +
                                                    model_.objects[id].text.text + "\"");
      }
      return OmissionReason::kNoMember;
    }
    add_option(id, true);
    question_.right = scene_.body_of(id) ? 1 : 0;
    return {};
  }

  MayOmit beside() {
    ObjectId a = ObjectId::kNone, b = ObjectId::kNone;
    if (auto why_not = resolve_there(family_.answer.who[0], a)) return why_not;
    if (auto why_not = resolve_there(family_.answer.who[1], b)) return why_not;
    if (a == b) return OmissionReason::kNoMember;
    question_.truth = family_.answer.kind == QuestionAnswer::kLeft
                          ? plan::QuestionTruth::kLeftOf
                          : plan::QuestionTruth::kNearerThan;
    question_.a = add_option(a, true);
    question_.b = add_option(b, true);
    return {};
  }

  MayOmit count() {
    ObjectId of = ObjectId::kNone;
    if (auto why_not = resolve_there(family_.answer.who[0], of)) return why_not;
    const AttributeId attribute = family_.answer.attribute;
    const auto value = value_of(model_, attribute, of);
    if (!value) return OmissionReason::kNotKnown;
    for (const ObjectId id : objects_) {
      const Truth truth = has_value(model_, attribute, *value, id);
      if (truth == Truth::kUnknown)
        return ambiguous(family_.answer.span, here() + "nothing says the `" +
                                                  model_.attributes[attribute].name + "` of `" +
                                                  model_.objects[id].name + "`");
      if (truth == Truth::kYes) add_option(id, true);
    }
    question_.right = static_cast<std::uint32_t>(question_.options.size());
    return {};
  }

  MayOmit mentions() {
    ObjectId what = ObjectId::kNone, to = ObjectId::kNone;
    if (auto why_not = resolve_there(family_.answer.who[0], what)) return why_not;
    if (auto why_not = resolve_there(family_.answer.who[1], to)) return why_not;
    if (what == to) return OmissionReason::kNoMember;
    if (asks_for_more()) return OmissionReason::kAmbiguous;
    if (auto why_not = check_role(family_.answer.who[0], what)) return why_not;
    if (auto why_not = check_role(family_.answer.who[1], to)) return why_not;
    if (auto why_not = check_options(objects_)) return why_not;
    // All of the scene, so that what is wrongly named is known.
    for (const ObjectId id : objects_) add_option(id, id == what || id == to);
    question_.truth = plan::QuestionTruth::kMentions;
    question_.a = *scene_.body_of(what);
    question_.b = *scene_.body_of(to);
    return {};
  }

  MayOmit recorded() {
    question_.truth = plan::QuestionTruth::kRecorded;
    question_.recorded = family_.answer.truth;
    if (family_.answer.kind == QuestionAnswer::kMetric) {
      const auto judged =
          std::find_if(task_.judged.begin(), task_.judged.end(), [&](const Metric& metric) {
            return metric.name == family_.answer.truth.name &&
                   metric.readout == plan::Readout::kAtEnd;
          });
      if (judged == task_.judged.end()) return OmissionReason::kNoSuchMetric;
      question_.recorded = *judged;
    }
    // What is measured must be there.
    const Mentioned measured = MentionedIn(model_).expression(question_.recorded->expr);
    for (const auto& [role, span] : measured.roles) {
      if (task_.objects_in(role).empty()) return OmissionReason::kNoMember;
    }
    for (const auto& [id, span] : measured.objects) {
      if (!scene_.body_of(id)) return OmissionReason::kNoMember;
    }
    if (measured.fixture && !model_.scenes[task_.scene].fixture) return OmissionReason::kNoMember;
    for (const ObjectId id : mentioned_) add_option(id, true);
    return {};
  }

  Context& context_;
  Ambiguities& ambiguities_;
  Relations& relations_;
  const Model& model_;
  const SceneObjects& scene_;
  QuestionSetId set_id_;
  const QuestionSet& set_;
  std::uint32_t family_index_;
  const Family& family_;
  const Task& task_;
  const std::vector<ObjectId>& objects_;
  PoolReader pools_;

  ObjectId bound_ = ObjectId::kNone;
  std::string text_, own_;
  std::vector<std::string> said_;
  std::vector<ObjectId> mentioned_;  // by the question's own words
  AskedQuestion question_;
};

}  // namespace

std::optional<OmissionReason> ask_family(Context& context, Ambiguities& ambiguities,
                                         Relations& relations, const SceneObjects& scene,
                                         QuestionSetId set, std::uint32_t family) {
  return FamilyAsker(context, ambiguities, relations, scene, set, family).ask();
}

}  // namespace probe::sema
