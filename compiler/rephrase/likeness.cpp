#include "compiler/rephrase/likeness.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "compiler/rephrase/relations.h"
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

// How many words there are if all of `phrase` stand from `at` on; 0: they do not.
std::size_t stands_at(const Words& words, std::size_t at, std::string_view phrase) {
  std::size_t count = 0, from = 0;
  while (from <= phrase.size()) {
    const std::size_t end = std::min(phrase.find(' ', from), phrase.size());
    if (at + count >= words.size() || words[at + count] != phrase.substr(from, end - from))
      return 0;
    ++count;
    from = end + 1;
  }
  return count;
}

std::size_t courtesy_at(const Words& words, std::size_t at) {
  for (const std::string_view courtesy : kCourtesies) {
    if (const std::size_t count = stands_at(words, at, courtesy); count > 0) return count;
  }
  return 0;
}

// The relation whose words stand from `at` on, the longest, and how many they are; 0: none does.
std::pair<std::string_view, std::size_t> relation_at(const Words& words, std::size_t at) {
  std::pair<std::string_view, std::size_t> longest;
  for (const Relation& relation : kRelations) {
    for (std::string_view left = relation.words; !left.empty();) {
      const std::size_t bar = std::min(left.find('|'), left.size());
      const std::size_t count = stands_at(words, at, left.substr(0, bar));
      if (count > longest.second) longest = {relation.name, count};
      left.remove_prefix(std::min(bar + 1, left.size()));
    }
  }
  return longest;
}

}  // namespace

std::string likeness(std::string_view wording) {
  const Words words = words_of(wording);
  Words left;
  for (std::size_t at = 0; at < words.size();) {
    if (const std::size_t polite = courtesy_at(words, at); polite > 0) {
      at += polite;
      continue;
    }
    const auto [relation, count] = relation_at(words, at);
    left.emplace_back(count > 0 ? relation : std::string_view(words[at]));
    at += std::max<std::size_t>(count, 1);
  }
  return sorted_text(left.empty() ? words : left);
}

}  // namespace probe::rephrase
