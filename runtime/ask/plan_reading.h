// How answers to a plan's questions are read: what read_answer and restate have to know of them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/ask/reading/mentions.h"
#include "runtime/ask/reading/read_answer.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

// `shown`: which of the question's options stood at each place (Wording::shown). `width`, `height`:
// of the picture that was sent, pixels.
ReadContext read_context(const plan::Plan& plan, const plan::QuestionRecord& question,
                         std::span<const std::uint32_t> shown, int width, int height);

// Of a question whose truth is kMentions.
Restatement restate(const plan::Plan& plan, const plan::QuestionRecord& question,
                    std::string_view raw, std::string_view finish);

}  // namespace probe::ask
