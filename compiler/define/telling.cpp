#include "compiler/define/telling.h"

#include <algorithm>

#include "compiler/model/same.h"

namespace probe::sema {

std::size_t sentence_count(const Task& task) { return 1 + task.later.size(); }

Task telling(const Task& task, std::size_t sentence) {
  Task told = task;
  told.later.clear();
  if (sentence > 0) {
    const LaterSentence& later = task.later[sentence - 1];
    told.say = later.say;
    told.say_span = later.say_span;
    told.prompt = later.text;
  }
  if (sentence < task.later.size()) {
    told.judged.push_back(task.later[sentence].when);
    told.judged.back().name = "success";
  }
  return told;
}

std::vector<const Metric*> measured_in(const Task& task) {
  std::vector<const Metric*> measured;
  measured.reserve(task.judged.size() + task.later.size());
  for (const Metric& metric : task.judged) measured.push_back(&metric);
  for (const LaterSentence& later : task.later) measured.push_back(&later.when);
  return measured;
}

bool same_turns(const Model& model, const Task& a, const Task& b) {
  return std::equal(a.later.begin(), a.later.end(), b.later.begin(), b.later.end(),
                    [&](const LaterSentence& here, const LaterSentence& there) {
                      return same_expression(model, here.when.expr, there.when.expr);
                    });
}

std::string whole_prompt(const Task& task) {
  std::string whole = task.prompt;
  for (const LaterSentence& later : task.later) whole += ", then " + later.text;
  return whole;
}

}  // namespace probe::sema
