#include "compiler/rephrase/leaks.h"

#include "compiler/rephrase/likeness.h"

namespace probe::rephrase {

Evaluations::Evaluations(const std::vector<Evaluation>& all) {
  for (const Evaluation& suite : all) {
    for (const Instruction& said : suite.instructions) {
      const Leak leak{suite.suite, said.task, said.text, true};
      exact_.try_emplace(said.text, leak);
      alike_.try_emplace(likeness(said.text), leak).first->second.is_exact = false;
    }
  }
}

std::optional<Leak> Evaluations::find(const std::string& wording) const {
  if (const auto same = exact_.find(wording); same != exact_.end()) return same->second;
  if (const auto close = alike_.find(likeness(wording)); close != alike_.end())
    return close->second;
  return std::nullopt;
}

}  // namespace probe::rephrase
