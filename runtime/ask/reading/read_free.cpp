// What is read of a sentence that answers freely.
#include <algorithm>

#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {
namespace {

std::optional<Reading> refused_free(const ReadContext&, const AnswerPart& part) {
  if (!part.named.empty() || !is_refusal(part.tokens)) return std::nullopt;
  return Reading{.verdict = Verdict::kRefused};
}

std::optional<Reading> sentence(const ReadContext& context, const AnswerPart& part) {
  Reading reading{.verdict = Verdict::kRead};
  for (const Named& name : part.named) {
    const std::uint32_t option = context.options[name.place].option;
    auto& known = reading.mentioned;
    if (std::find(known.begin(), known.end(), option) == known.end()) known.push_back(option);
  }
  return reading;
}

constexpr ReadRule kFreeRules[] = {
    {"refused", "words that say that it cannot or will not answer, and no object", refused_free},
    {"sentence", "the objects that it names, in their order, each once", sentence},
};

}  // namespace

std::span<const ReadRule> free_rules() { return kFreeRules; }

}  // namespace probe::ask
