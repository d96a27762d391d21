#include "compiler/define/right_answer.h"

#include <algorithm>

#include "compiler/define/query.h"
#include "compiler/define/views.h"
#include "compiler/lower/lower.h"
#include "compiler/model/mentioned.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

using plan::OmissionReason;

class RightAnswer {
 public:
  RightAnswer(const FamilyOfTask& asked, const Referents& referents, const QuestionText& text,
              const PoolReader& pools, ObjectId bound, AskedQuestion& question)
      : asked_(asked),
        referents_(referents),
        text_(text),
        pools_(pools),
        bound_(bound),
        question_(question),
        model_(asked.model()),
        scene_(asked.scene),
        family_(asked.family()),
        task_(asked.task()),
        objects_(asked.objects()) {}

  MayOmit find() {
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
        return judged();
    }
    return OmissionReason::kNoMember;
  }

 private:
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

  bool says_instruction() const {
    return std::any_of(family_.parts.begin(), family_.parts.end(), [](const Family::Part& part) {
      return part.placeholder && part.placeholder->kind == Placeholder::kInstruction;
    });
  }

  MayOmit choice() {
    ObjectId right = ObjectId::kNone;
    if (auto why_not = referents_.resolve_there(family_.answer.who[0], right)) return why_not;
    if (says_instruction()) {
      if (auto why_not = referents_.check_role(family_.answer.who[0], right)) return why_not;
    }
    if (auto why_not = referents_.check_attributes(right)) return why_not;
    if (has_words(fold_case(text_.own()), scene_.name(right))) return OmissionReason::kShowsAnswer;
    const std::vector<ObjectId> options =
        pools_.drawn("vlaprobe.order", pools_.members(*family_.among, bound_));
    if (options.size() < 2) return OmissionReason::kOneOption;
    if (options.size() > plan::kMaxOptions) {
      asked_.context.report(Situation::kTooManyOptions, family_.answer.span,
                            asked_.here() + "expected at most " +
                                std::to_string(plan::kMaxOptions) + " options, found " +
                                std::to_string(options.size()));
      return OmissionReason::kAmbiguous;
    }
    if (auto why_not = referents_.check_options(options)) return why_not;
    for (const ObjectId id : options) add_option(id, id == right);
    question_.right = static_cast<std::uint32_t>(std::find(options.begin(), options.end(), right) -
                                                 options.begin());
    return {};
  }
  MayOmit point() {
    ObjectId id = ObjectId::kNone;
    if (auto why_not = referents_.resolve_there(family_.answer.who[0], id)) return why_not;
    if (says_instruction()) {
      if (auto why_not = referents_.check_role(family_.answer.who[0], id)) return why_not;
    }
    question_.truth = plan::QuestionTruth::kPixelsOf;
    question_.a = add_option(id, true);
    return {};
  }

  MayOmit present() {
    ObjectId id = ObjectId::kNone;
    if (auto why_not = referents_.resolve(family_.answer.who[0], id)) return why_not;
    if (!scene_.body_of(id) && !pools_.can_be_absent(id, bound_)) {
      for (const ObjectId other : objects_) {
        if (scene_.names().are_alike(id, other))
          return referents_.ambiguous(
              family_.answer.span, asked_.here() + "`" + model_.objects[other].name +
                                       "` may count as \"" + model_.objects[id].text.text + "\"");
      }
      return OmissionReason::kNoMember;
    }
    add_option(id, true);
    question_.right = scene_.body_of(id) ? 1 : 0;
    return {};
  }

  MayOmit beside() {
    ObjectId a = ObjectId::kNone, b = ObjectId::kNone;
    if (auto why_not = referents_.resolve_there(family_.answer.who[0], a)) return why_not;
    if (auto why_not = referents_.resolve_there(family_.answer.who[1], b)) return why_not;
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
    if (auto why_not = referents_.resolve_there(family_.answer.who[0], of)) return why_not;
    const AttributeId attribute = family_.answer.attribute;
    const auto value = value_of(model_, attribute, of);
    if (!value) return OmissionReason::kNotKnown;
    for (const ObjectId id : objects_) {
      const Truth truth = has_value(model_, attribute, *value, id);
      if (truth == Truth::kUnknown)
        return referents_.ambiguous(family_.answer.span, asked_.here() + "nothing says the `" +
                                                             model_.attributes[attribute].name +
                                                             "` of `" + model_.objects[id].name +
                                                             "`");
      if (truth == Truth::kYes) add_option(id, true);
    }
    question_.right = static_cast<std::uint32_t>(question_.options.size());
    return {};
  }

  MayOmit mentions() {
    ObjectId what = ObjectId::kNone, to = ObjectId::kNone;
    if (auto why_not = referents_.resolve_there(family_.answer.who[0], what)) return why_not;
    if (auto why_not = referents_.resolve_there(family_.answer.who[1], to)) return why_not;
    if (what == to) return OmissionReason::kNoMember;
    if (referents_.asks_for_more()) return OmissionReason::kAmbiguous;
    if (auto why_not = referents_.check_role(family_.answer.who[0], what)) return why_not;
    if (auto why_not = referents_.check_role(family_.answer.who[1], to)) return why_not;
    if (auto why_not = referents_.check_options(objects_)) return why_not;
    // All of the scene, so that what is wrongly named is known.
    for (const ObjectId id : objects_) add_option(id, id == what || id == to);
    question_.truth = plan::QuestionTruth::kMentions;
    question_.a = *scene_.body_of(what);
    question_.b = *scene_.body_of(to);
    return {};
  }

  MayOmit judged() {
    question_.truth = family_.moment == plan::QuestionMoment::kEnd
                          ? plan::QuestionTruth::kRecorded
                          : plan::QuestionTruth::kSettled;
    question_.judged = family_.answer.truth;
    if (family_.answer.kind == QuestionAnswer::kMetric) {
      const auto metric =
          std::find_if(task_.judged.begin(), task_.judged.end(), [&](const Metric& one) {
            return one.name == family_.answer.truth.name &&
                   one.readout == plan::Readout::kAtEnd;
          });
      if (metric == task_.judged.end()) return OmissionReason::kNoSuchMetric;
      question_.judged = *metric;
    }
    // What is measured must be there.
    const Mentioned measured = MentionedIn(model_).expression(question_.judged->expr);
    for (const auto& [role, span] : measured.roles) {
      if (task_.objects_in(role).empty()) return OmissionReason::kNoMember;
    }
    for (const auto& [id, span] : measured.objects) {
      if (!scene_.body_of(id)) return OmissionReason::kNoMember;
    }
    if (measured.fixture && !model_.scenes[task_.scene].fixture) return OmissionReason::kNoMember;
    if (model_.fixtures.size() > 0 && !can_be_measured()) return OmissionReason::kNoMember;
    for (const ObjectId id : text_.mentioned()) add_option(id, true);
    return {};
  }

  // Parts and joints that are asked about are in the scene, and a role is filled with what is
  // measured of it.
  bool can_be_measured() const {
    Diagnostics unsaid;
    const Scene& scene = model_.scenes[task_.scene];
    const CameraId camera = views_of(model_, task_).front().camera;
    return lower::lower_metrics(model_, {&*question_.judged, 1},
                                lower::bodies_of(model_, task_),
                                frame_of(model_, scene, model_.cameras[camera]), unsaid)
        .has_value();
  }

  const FamilyOfTask& asked_;
  const Referents& referents_;
  const QuestionText& text_;
  const PoolReader& pools_;
  ObjectId bound_;
  AskedQuestion& question_;
  const Model& model_;
  const SceneObjects& scene_;
  const Family& family_;
  const Task& task_;
  const std::vector<ObjectId>& objects_;
};

}  // namespace

MayOmit find_right_answer(const FamilyOfTask& asked, const Referents& referents,
                          const QuestionText& text, const PoolReader& pools, ObjectId bound,
                          AskedQuestion& question) {
  return RightAnswer(asked, referents, text, pools, bound, question).find();
}

}  // namespace probe::sema
