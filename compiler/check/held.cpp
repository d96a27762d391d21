#include "compiler/check/held.h"

#include <array>
#include <string_view>

#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/define/telling.h"
#include "compiler/define/wording.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// How something is done.
constexpr auto kManners =
    std::to_array<std::string_view>({"carefully", "gently", "slowly", "quickly"});

}  // namespace

std::vector<NotHeld> not_held(const Model& model, const Task& task, Callings& callings) {
  std::vector<NotHeld> found;
  std::size_t sentence = 0;
  for_each_telling(task, [&](const Task& told) {
    ++sentence;
    const Template& say = model.templates[told.say];
    // Words that ask for nothing, to see what is done then.
    if (is_control(say)) return;
    if (sentence != sentence_count(task)) {
      found.push_back({told.prompt, "another sentence follows"});
      return;
    }
    const Clauses clauses = clauses_of(model, told, callings);
    for (NotHeld& one : words_not_held(model, told, clauses, goal_of(model, told)))
      found.push_back(std::move(one));
    for (const std::string_view word : kManners) {
      for (const Template::Part& part : say.parts) {
        if (has_words(fold_case(part.literal), word))
          found.push_back({std::string(word), "how it is done is measured by nothing"});
      }
    }
  });
  return found;
}

}  // namespace probe::sema
