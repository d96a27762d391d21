// Every wording of a task that its templates and phrases can make and that is proved to mean the
// same in each of its starts. All starts of a task have the same objects: what a phrase says of
// what they are holds in every start or in none. What it says of where they lie is proved in each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/check/mention.h"
#include "compiler/define/in_start.h"
#include "compiler/model/model.h"
#include "compiler/rephrase/actions.h"
#include "compiler/rephrase/refusal.h"
#include "runtime/base/asset_root.h"

namespace probe::rephrase {

struct Wording {
  std::string text;
  sema::TemplateId say = sema::TemplateId::kNone;
  const sema::Phrase* source = nullptr;  // null: by its name
  const sema::Phrase* target = nullptr;
};

// candidates = wordings + refused + same_words + not_drawn.
struct Proved {
  std::vector<Wording>
      wordings;  // templates in the order of the text, then phrases; never the instruction
  std::uint64_t candidates = 0;  // template x words for the source x words for the target
  Refused refused;
  std::uint64_t same_words = 0;  // those that another one of the task has, or the instruction
  std::uint64_t not_drawn = 0;   // of a task with more than kMostEnumerated that fit
};

// Of more than these, kMostDrawn are drawn by `seed`, the task's name and a counter.
inline constexpr std::uint64_t kMostEnumerated = 65'536, kMostDrawn = 16'384;

class Prover {
 public:
  // The model must live as long; it has no errors. `asset_root`: of the meshes whose middles the
  // relations of phrases measure.
  explicit Prover(const sema::Model& model, AssetRoot asset_root = {});

  // Of a concrete task.
  Proved prove(const sema::Task& task, std::uint64_t seed);

 private:
  struct Choice;
  std::vector<Choice> choices(const sema::Task& task, bool is_source, bool is_said);
  std::optional<Refusal> why_no_phrase(const sema::Task& task, sema::ObjectId wanted,
                                       const sema::Phrase& phrase);
  std::optional<Refusal> why_not_there(const sema::Task& task, sema::ObjectId wanted,
                                       const sema::Phrase& phrase);
  std::optional<Refusal> why_not(const sema::Task& task, sema::TemplateId say);

  const sema::Model& model_;
  Actions actions_;
  sema::Mentions mentions_;
  Diagnostics unsaid_;  // what cannot be measured is said where a task refers by it
  sema::Relations relations_;
};

}  // namespace probe::rephrase
