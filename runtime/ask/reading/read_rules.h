// The rules of reading by form: parts of read_answer. One row one rule; the first that gives a
// reading decides.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/ask/reading/read_answer.h"

namespace probe::ask {

// The part of an answer that is read.
struct AnswerPart {
  std::string_view text;  // in plain form
  const Tokens& tokens;
  const std::vector<Named>& named;  // of the context's options
};

struct ReadRule {
  std::string_view name;
  std::string_view says;
  std::optional<Reading> (*read)(const ReadContext& context, const AnswerPart& part);
};

std::span<const ReadRule> choice_rules();
std::span<const ReadRule> yesno_rules();
std::span<const ReadRule> number_rules();
std::span<const ReadRule> point_rules();
std::span<const ReadRule> free_rules();

// The part of a free answer that is read, in plain form: without thoughts, and out of a tag, a box
// or JSON where there is one. For answers that read_answer reads.
std::string free_part(std::string_view raw);

inline Reading unclear() { return {.verdict = Verdict::kUnclear}; }

// Sentences and lines: tokens between two ends, as [begin, end); never empty ones.
std::vector<std::pair<std::size_t, std::size_t>> sentences_of(std::span<const Token> tokens);
std::vector<std::pair<std::size_t, std::size_t>> lines_of(std::span<const Token> tokens);

// Whether a word before `at`, in its clause, denies what stands there.
bool is_denied(std::span<const Token> tokens, std::size_t at);

}  // namespace probe::ask
