// Text in parentheses: lists of words and lists, each with the line and the column where it begins.
// Knows nothing of what the words mean.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::libero {

// Where something stands in a text, both counted from 1; columns are bytes.
struct Spot {
  std::uint32_t line = 1, column = 1;

  friend auto operator<=>(const Spot&, const Spot&) = default;
};

// "file.bddl:3:14".
std::string place_of(std::string_view path, Spot spot);

struct Sexpr {
  bool is_list = false;
  std::string_view word;             // of no list; within the text, as written
  std::vector<std::uint32_t> items;  // of Sexprs::nodes
  Spot spot;                         // of the word, or of the opening bracket
};

// The one list that a text is.
struct Sexprs {
  std::vector<Sexpr> nodes;
  std::uint32_t root = 0;

  const Sexpr& at(std::uint32_t node) const { return nodes[node]; }
  const Sexpr& top() const { return nodes[root]; }
  // The word at the beginning of a list; empty where it begins with a list, or with nothing.
  std::string_view head(const Sexpr& list) const;
};

// `text` must outlive what is read; `;` begins a comment. Fails (kUsage, where = place in `path`)
// on a bracket without its other half, text behind the list, no list at all, lists more than 32
// deep.
Result<Sexprs> read_sexpr(std::string_view text, std::string_view path);

}  // namespace probe::libero
