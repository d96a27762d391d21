#include "compiler/rephrase/likeness.h"

#include <algorithm>
#include <array>
#include <vector>

#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"

namespace probe::rephrase {
namespace {

constexpr bool is_sign(char c) {
  const auto byte = static_cast<unsigned char>(c);
  const bool is_word =
      (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || byte >= 0x80;
  return !is_word;
}

// Apostrophes and typographic quotes, at the beginning of a text: how many bytes.
std::size_t apostrophe(std::string_view text) {
  for (const std::string_view sign : {"'", "\u2019", "\u2018"}) {
    if (text.starts_with(sign)) return sign.size();
  }
  return 0;
}

using Words = std::vector<std::string>;

// In lower case and in their order, without signs and articles.
Words words_of(std::string_view wording) {
  const std::string text = fold_case(wording);
  Words words(1);
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t bytes = apostrophe(std::string_view(text).substr(at)); bytes > 0) {
      at += bytes;
      continue;
    }
    const char c = text[at++];
    if (!is_sign(c)) {
      words.back().push_back(c);
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  std::erase_if(words, [](const std::string& word) { return word.empty() || is_article(word); });
  return words;
}

std::string sorted_text(Words words) {
  std::sort(words.begin(), words.end());
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

// Words that ask politely and say nothing of what is to be done; the longer ones first.
constexpr auto kCourtesies = std::to_array<std::string_view>(
    {"i would like you to", "id like you to", "i want you to", "i need you to", "could you",
     "can you", "would you", "will you", "thank you", "thanks", "please", "kindly"});

// How many words the courtesy that begins at `at` has; 0: none does.
std::size_t courtesy_at(const Words& words, std::size_t at) {
  for (const std::string_view courtesy : kCourtesies) {
    std::size_t count = 0, from = 0;
    bool stands = true;
    while (stands && from <= courtesy.size()) {
      const std::size_t end = std::min(courtesy.find(' ', from), courtesy.size());
      stands = at + count < words.size() && words[at + count] == courtesy.substr(from, end - from);
      ++count;
      from = end + 1;
    }
    if (stands) return count;
  }
  return 0;
}

}  // namespace

std::string likeness(std::string_view wording) { return sorted_text(words_of(wording)); }

std::string likeness_without_courtesy(std::string_view wording) {
  const Words words = words_of(wording);
  Words left;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t polite = courtesy_at(words, at);
    if (polite == 0) left.push_back(words[at]);
    at += std::max<std::size_t>(polite, 1);
  }
  return sorted_text(left.empty() ? words : left);
}

}  // namespace probe::rephrase
