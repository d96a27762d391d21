// "left of", "behind": held to whether success tells one side from another.
#include <algorithm>
#include <array>
#include <string_view>

#include "compiler/check/word_lacks.h"

namespace probe::sema {
namespace {

// "On the plate behind the towel": which plate.
bool follows_place(Told& told, std::size_t at) {
  const auto& words = told.said().words;
  std::size_t noun = at;
  while (noun > 0 && words[noun - 1].of.empty()) --noun;
  if (noun == 0 || noun != at) return false;
  constexpr auto kOn = std::to_array<std::string_view>({"on", "in", "into", "onto", "inside"});
  for (std::size_t i = noun - 1; i > 0 && i + 4 > noun; --i) {
    if (std::ranges::find(kOn, words[i - 1].text) != kOn.end()) return true;
    if (!words[i - 1].of.empty() || words[i - 1].ends) return false;
  }
  return false;
}

// "Not to the left", "to the right, not to the left", "the one to the left": no way that it goes.
bool is_no_way(Told& told, std::size_t at, std::string_view other) {
  constexpr auto kDenies = std::to_array<std::string_view>(
      {"not", "don't", "never", "no", "neither", "nor", "without", "avoid", "instead", "rather"});
  const auto& words = told.said().words;
  const auto denies = [&](const Said::Word& word) {
    return std::ranges::find(kDenies, word.text) != kDenies.end();
  };
  const auto before = words.begin() + static_cast<std::ptrdiff_t>(at);
  return std::any_of(words.begin(), before, denies) ||
         std::any_of(words.begin(), words.end(),
                     [&](const auto& word) { return word.text == other; }) ||
         (at > 0 && words[at - 1].text == "one") || told.tells_which(at);
}

// Whether another sentence follows, which success at the end is about.
bool is_before_another(const Task& task) {
  return std::ranges::count(task.judged, "success", &Metric::name) > 1;
}

// "Move the cube to the left" of which success is that it went to the right.
std::optional<std::string> other_way(Told& told, const GoalWords& one) {
  using Went = Goal::Went;
  const bool is_left = one.words == "to the left";
  if (!is_left && one.words != "to the right") return std::nullopt;
  const auto at = told.said().find(one.words);
  const auto& words = told.said().words;
  if (!at || (*at + 3 < words.size() && words[*at + 3].text == "of")) return std::nullopt;
  if (is_no_way(told, *at, is_left ? "right" : "left") || is_before_another(told.task()))
    return std::nullopt;
  const auto& went = told.goal().went;
  for (const auto& [thing, way] : went) {
    if (way != (is_left ? Went::kRight : Went::kLeft) ||
        went.contains({thing, is_left ? Went::kLeft : Went::kRight}) || went.size() != 1)
      continue;
    return "success wants " + told.name_of(Things{thing}) + " to be farther to the " +
           (is_left ? "right" : "left") + " than it began";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> side_word_lack(Told& told, const GoalWords& one) {
  if (auto lack = other_way(told, one)) return lack;
  if (told.goal().tells_sides) return std::nullopt;
  const std::size_t length = folded_words(one.words).size();
  for (auto at = told.said().find(one.words); at; at = told.said().find(one.words, *at + 1)) {
    // "next to the left knob" says of a knob which it is.
    const std::size_t next = *at + length;
    const bool is_side = one.words.ends_with("left") || one.words.ends_with("right");
    if (is_side && next < told.said().words.size()) {
      const std::string& word = told.said().words[next].text;
      if (word != "of" && word != "and" && word != "then" && word != "side") continue;
    }
    // "Pick up the book on the right" says which book; "take it to the right" says where to.
    const auto& words = told.said().words;
    const bool says_whither =
        one.words.starts_with("to the") ||
        (*at >= 2 && words[*at - 2].text == "to" && words[*at - 1].text == "the");
    if (!says_whither && (told.tells_which(*at) || follows_place(told, *at))) continue;
    return "its success measures nothing that tells one side from another";
  }
  return std::nullopt;
}

}  // namespace probe::sema
