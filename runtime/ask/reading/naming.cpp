#include "runtime/ask/reading/naming.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace probe::ask {
namespace {

// What a name of a colour or a material describes when it stands before it.
constexpr auto kDescribed = std::to_array<std::string_view>(
    {"object", "objects", "thing", "things", "item", "items", "one", "ones", "color", "colour",
     "colored", "coloured", "shape", "shaped", "block", "cube", "piece", "vegetable", "fruit"});

// What may stand before the last word of a name for it to mean that name.
constexpr auto kBeforeHead = std::to_array<std::string_view>(
    {"a",  "an",   "the",  "this", "that",  "its", "in",   "into", "inside", "on",  "onto", "to",
     "of", "with", "from", "is",   "be",    "not", "put",  "and",  "or",     "up",  "grab", "take",
     "by", "only", "over", "move", "place", "for", "pick", "at",   "hold",   "near"});

bool contains(const auto& table, std::string_view word) {
  return std::find(table.begin(), table.end(), word) != table.end();
}

bool is_part(const Token& token) {
  return token.kind == TokenKind::kWord || token.kind == TokenKind::kNumber;
}

}  // namespace

std::vector<std::string> plain_words(std::string_view text) {
  std::vector<std::string> words;
  for (Token& token : tokens_of(plain_form(text))) {
    if (is_part(token) && !is_article(token.text)) words.push_back(std::move(token.text));
  }
  return words;
}

bool stands_in(const std::vector<std::string>& part, const std::vector<std::string>& whole) {
  if (part.empty()) return false;
  return std::search(whole.begin(), whole.end(), part.begin(), part.end(),
                     [](const std::string& a, const std::string& b) {
                       return is_same_noun(a, b);
                     }) != whole.end();
}

NameTable::NameTable(std::span<const ShownOption> options, std::string_view question) {
  const std::vector<std::string> asked = plain_words(question);
  for (std::uint32_t place = 0; place < options.size(); ++place) {
    const ShownOption& option = options[place];
    std::vector<std::vector<std::string>> known;  // a plain name is often among the words, too
    for (std::uint32_t word = 0; word <= option.words.size(); ++word) {
      auto words = plain_words(word == 0 ? option.name : option.words[word - 1]);
      if (words.empty() || std::find(known.begin(), known.end(), words) != known.end()) continue;
      known.push_back(words);
      const auto& name = known.front();
      if (words.size() < name.size() &&
          std::equal(words.begin(), words.end(), name.end() - static_cast<long>(words.size()))) {
        entries_.push_back({place, 0, true, false, std::move(words)});
        continue;
      }
      const bool is_echo = word > 0 && stands_in(words, asked);
      entries_.push_back({place, word, false, is_echo, std::move(words)});
    }
  }
  const std::size_t whole = entries_.size();
  for (std::size_t i = 0; i < whole; ++i) {
    const Entry& name = entries_[i];
    if (name.word != 0 || name.is_head || name.words.size() < 2) continue;
    const std::string head = name.words.back();
    const bool shared = std::any_of(
        entries_.begin(), entries_.begin() + static_cast<long>(whole), [&](const Entry& other) {
          return other.place != name.place &&
                 std::any_of(other.words.begin(), other.words.end(),
                             [&](const std::string& word) { return is_same_noun(word, head); });
        });
    const bool known = std::any_of(entries_.begin(), entries_.end(), [&](const Entry& other) {
      return other.place == name.place && other.is_head && other.words.size() == 1;
    });
    if (!shared && !known) entries_.push_back({name.place, 0, true, false, {head}});
  }
}

std::size_t NameTable::length_at(const Entry& entry, std::span<const Token> tokens,
                                 std::size_t at) {
  std::size_t i = at;
  for (std::size_t w = 0; w < entry.words.size(); ++w) {
    while (w > 0 && i < tokens.size() && tokens[i].is_word() && is_article(tokens[i].text)) ++i;
    if (i >= tokens.size() || !is_part(tokens[i])) return 0;
    const bool is_last = w + 1 == entry.words.size();
    const bool same =
        is_last ? is_same_noun(tokens[i].text, entry.words[w]) : tokens[i].text == entry.words[w];
    if (!same) return 0;
    ++i;
  }
  return i - at;
}

std::vector<Named> NameTable::find(std::span<const Token> tokens) const {
  std::vector<Named> found;
  std::size_t at = 0;
  while (at < tokens.size()) {
    std::size_t longest = 0;
    if (is_part(tokens[at])) {
      for (const Entry& entry : entries_) {
        if (entry.is_head && at > 0 && is_part(tokens[at - 1]) &&
            !contains(kBeforeHead, tokens[at - 1].text))
          continue;
        longest = std::max(longest, length_at(entry, tokens, at));
      }
    }
    if (longest == 0) {
      ++at;
      continue;
    }
    const std::size_t end = at + longest;
    const bool describes = longest == 1 && end < tokens.size() && tokens[end].is_word() &&
                           contains(kDescribed, tokens[end].text);
    for (const Entry& entry : entries_) {
      if (describes || length_at(entry, tokens, at) != longest) continue;
      const bool known =
          !found.empty() && found.back().begin == at && found.back().place == entry.place;
      if (!known) found.push_back({entry.place, entry.word, entry.is_head, entry.is_echo, at, end});
    }
    at = end;
  }
  return found;
}

}  // namespace probe::ask
