// The exact words of a query: the one place where a question of a plan becomes a text that is sent.
// Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

struct Wording {
  std::string text;
  // Which of the question's options stands at each place; letters A, B, ... where it is a choice.
  std::vector<std::uint32_t> shown;
};

// `width`, `height`: of the picture that is sent, which a question for a point tells. A choice
// shows option (place + rotation) % n at each place; other forms keep their options' order.
Wording word(const plan::Plan& plan, const plan::QuestionRecord& question, std::uint32_t rotation,
             int width, int height);

// The size that the words of a question for a point tell; nothing where they tell none.
struct ToldSize {
  int width = 0, height = 0;
};
std::optional<ToldSize> told_size(std::string_view words);

// Of a place among a choice's options.
inline std::string letter_of(std::size_t place) {
  return std::string(1, static_cast<char>('A' + static_cast<char>(place)));
}

// The options of a question, and what each is called.
std::span<const plan::OptionRecord> options_of(const plan::Plan& plan,
                                               const plan::QuestionRecord& question);

}  // namespace probe::ask
