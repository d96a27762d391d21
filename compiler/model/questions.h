// What a model is asked: the declared families, and what each of them asks of each task, with the
// right answer. Part of the model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/model/expr.h"
#include "compiler/model/ids.h"
#include "compiler/source/source.h"
#include "runtime/plan/format.h"

namespace probe::syntax {
struct File;
}

namespace probe::sema {

// Of which object something is said.
struct Who {
  enum Kind : std::uint8_t { kSource, kTarget, kAvoided, kBound, kObject, kRole };
  Kind kind = kSource;
  ObjectId object = ObjectId::kNone;  // kObject
  std::string text;                   // as written
  Span span;
  RoleId role = RoleId::kNone;  // kRole: one that is declared
  bool operator==(const Who& other) const {
    return kind == other.kind && object == other.object && role == other.role;
  }
};

// `{the phrase of source}`
struct Placeholder {
  enum Kind : std::uint8_t { kInstruction, kName, kPhrase, kAttribute };
  enum Article : std::uint8_t { kBare, kThe, kA };
  Kind kind = kName;
  Article article = kBare;
  Who who;                                     // not of kInstruction
  AttributeId attribute = AttributeId::kNone;  // kAttribute; none: declared nowhere, and so unknown
  Span span;
};

// Objects that are asked about or offered: those of the scene, or all of the catalogue.
struct QuestionPool {
  bool is_catalogue = false;
  std::uint64_t absent = 0;  // how many beside those of the scene that are not there
};

struct QuestionAnswer {
  enum Kind : std::uint8_t {
    kOne,
    kPresent,
    kLeft,
    kNearer,
    kCount,
    kMentions,
    kMetric,
    kCondition
  };
  Kind kind = kOne;
  std::vector<Who> who;                        // as many as the kind takes
  AttributeId attribute = AttributeId::kNone;  // kCount, as of a placeholder
  Metric truth;                                // kMetric: its name alone; kCondition
  std::string_view called;                     // kCondition: the predicate it is, if it is one
  Span span;
};

// One statement of a `questions` declaration.
struct Family {
  std::string name;
  Span span;  // of the name
  plan::QuestionForm form = plan::QuestionForm::kChoice;
  plan::QuestionMoment moment = plan::QuestionMoment::kStart;
  std::string text;  // as written
  Span text_span;
  struct Part {
    std::string literal;
    std::optional<Placeholder> placeholder;
  };
  std::vector<Part> parts;
  std::optional<QuestionPool> over;  // `for o in`
  QuestionAnswer answer;
  std::optional<QuestionPool> among;  // of a choice
  std::uint32_t pixels = 0;
  std::uint32_t where = 0xffffffffu;  // syntax::CondId in the file of the set
  bool broken = false;                // something was reported: it is not asked
};

struct QuestionSet {
  std::string name;
  Span span;       // of the name
  Span decl_span;  // of the declaration
  const syntax::File* file = nullptr;
  bool allow_ambiguous = false;  // a question without a single right answer is left out
  bool allow_same = false;       // and one of two options that are called the same
  std::vector<Family> families;
};

// A family asked of a task.
struct AskedOption {
  ObjectId object = ObjectId::kNone;
  std::optional<std::uint32_t> body;  // its place in the task; none: it is not in the scene
  bool must_be_seen = false;
  std::vector<std::string> words;  // what denotes it alone among the options, beside its name
};
struct AskedQuestion {
  QuestionSetId set = QuestionSetId::kNone;
  std::uint32_t family = 0;  // of the set
  TaskId task = TaskId::kNone;
  std::string text;
  std::vector<AskedOption> options;
  plan::QuestionTruth truth = plan::QuestionTruth::kProved;
  std::uint32_t right = plan::kNone;
  std::uint32_t a = plan::kNone, b = plan::kNone;
  std::optional<Metric> judged;  // the condition, of the settled start or the recorded episode
};
struct LeftOut {
  QuestionSetId set = QuestionSetId::kNone;
  std::uint32_t family = 0;
  TaskId task = TaskId::kNone;
  plan::OmissionReason reason{};
};

}  // namespace probe::sema
