// The words of a relation in a text. Header only.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.h"
#include "runtime/base/words.h"

namespace probe::sema {

// Of a folded text: whether one of the relation's words stands in it.
inline bool says(std::string_view text, const Predicate& relation) {
  return std::any_of(relation.words.begin(), relation.words.end(),
                     [&](const std::string& words) { return has_words(text, words); });
}

// For messages: "left", "to the left".
inline std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return text;
}

}  // namespace probe::sema
