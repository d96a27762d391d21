// What a server tells of how likely each letter was where a letter was written, and which of these
// places is the one that the answer is read from. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/read_answer.h"
#include "runtime/base/json.h"

namespace probe::ask {

// A letter that the answer's text has as a token of its own, signs aside ("B", " B", "(B").
struct WrittenLetter {
  std::size_t place = 0;  // 0 for A
  std::size_t begin = 0;  // of the letter, bytes of the answer's text
  // Natural logarithms of the letters' probabilities there, by letter: of the sum of a letter's
  // tokens ("A" and " A" are one). Empty where the table is junk: numbers that are none, not finite
  // or above 0, one token twice, no letter.
  std::vector<std::optional<double>> logprobs = {};
};

// Of `choices[0].logprobs` of the chat interface and the answer's text, of the first `letters`
// letters; null where the server tells none.
std::vector<WrittenLetter> written_letters(const Json* logprobs, std::string_view raw,
                                           std::size_t letters);
// Finite, and no more above 0 than rounding leaves the logarithm of a certain token.
bool is_logprob(double value);
// Whether there is such a table at all.
bool tells_logprobs(const Json* logprobs);

// Of the letter that `reading`, the reader's of that answer, is taken from: the first of those
// written that with another letter in its place would be read otherwise. Empty where it is taken
// from none.
std::vector<std::optional<double>> at_read_letter(const AnswerReader& reader,
                                                  std::span<const WrittenLetter> written,
                                                  std::string_view raw, std::string_view finish,
                                                  const Reading& reading);

}  // namespace probe::ask
