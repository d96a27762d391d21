// Which options a text names, and with which of their words. Knows no questions and no letters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_text.h"

namespace probe::ask {

// An option as an answer may speak of it.
struct ShownOption {
  std::uint32_t option = 0;             // of the question's options
  std::string name = {};                // the plain name, as shown
  std::vector<std::string> words = {};  // what else denotes it alone among the options
};

struct Named {
  std::uint32_t place = 0;  // of the options that were given
  // Which of its words: 0 the plain name, i + 1 its `words[i]`.
  std::uint32_t word = 0;
  bool is_head = false;  // the last word of the plain name alone: "basket"
  // Not the plain name, and words that the question has itself: who repeats them has said nothing.
  bool is_echo = false;
  std::size_t begin = 0, end = 0;  // tokens; articles inside belong to it, one before does not
};

// The options' words as the matcher wants them; made once for many texts.
class NameTable {
 public:
  // `question`: whose words are echoes.
  explicit NameTable(std::span<const ShownOption> options, std::string_view question = {});

  // In the order of the text; the longest words at a place win and are used up, so that "orange
  // juice" names no orange. Words that two options have give one entry each. The last word may be
  // in the plural, articles inside do not count. The last word of a plain name names it, too, where
  // an option's words say so or no other option has that word, and no other adjective stands
  // before. A name before a word such as "object" or "one" only describes ("the orange object") and
  // is none.
  std::vector<Named> find(std::span<const Token> tokens) const;

 private:
  struct Entry {
    std::uint32_t place = 0, word = 0;
    bool is_head = false, is_echo = false;
    std::vector<std::string> words;  // folded, without articles
  };
  // Tokens that the entry takes from `at` on; 0: it does not stand there.
  static std::size_t length_at(const Entry& entry, std::span<const Token> tokens, std::size_t at);

  std::vector<Entry> entries_;
};

// Words and numbers of a text, folded, without articles.
std::vector<std::string> plain_words(std::string_view text);

// Whether `part` stands in `whole`, word by word, nouns in either number.
bool stands_in(const std::vector<std::string>& part, const std::vector<std::string>& whole);

}  // namespace probe::ask
