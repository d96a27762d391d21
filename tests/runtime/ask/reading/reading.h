// Readings in short, for tables of answers: what was read and by which rule.
#pragma once

#include <string>

#include "runtime/ask/reading/read_answer.h"

namespace probe::ask {

// Options of the tests: A carrot, B plate, C orange juice, D yellow basket.
inline std::vector<ShownOption> shown_options() {
  return {{7, "carrot", {"carrot", "orange object", "rabbit's favorite vegetable"}},
          {5, "plate", {"plate", "round shaped object"}},
          {2, "orange juice", {"orange juice", "drink rich in vitamin C"}},
          {0, "yellow basket", {"yellow basket"}}};
}

inline ReadContext context_of(plan::QuestionForm form) {
  return {.form = form,
          .options = shown_options(),
          .question = "Is there a carrot on the table?",
          .width = 640,
          .height = 480};
}

// "option 7", "yes", "no", "3", "123 45", "7 5", or the verdict where nothing was read.
inline std::string in_short(const Reading& reading) {
  if (reading.verdict != Verdict::kRead) return std::string(word_of(reading.verdict));
  if (reading.option) return "option " + std::to_string(*reading.option);
  if (reading.yes) return *reading.yes ? "yes" : "no";
  if (reading.number) return std::to_string(*reading.number);
  const auto number = [](double v) {
    std::string text = std::to_string(v);
    while (text.ends_with('0')) text.pop_back();
    if (text.ends_with('.')) text.pop_back();
    return text;
  };
  if (reading.point) return number(reading.point->x) + " " + number(reading.point->y);
  std::string text;
  for (const std::uint32_t option : reading.mentioned)
    text += (text.empty() ? "" : " ") + std::to_string(option);
  return text;
}

struct Answered {
  std::string raw;
  std::string read, rule;
};

}  // namespace probe::ask
