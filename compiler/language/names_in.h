// Every name of a file with what it can stand for there: the tree's words as a list, in the order of
// the text. Knows the grammar; not which names are declared, nor where.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/language/kinds.h"
#include "compiler/syntax/ast.h"

namespace probe::language {

struct Place {
  Span span;
  std::string_view text;
  Kinds may_be;
  bool declares = false;
  // Of a value its attribute; of a member whom it is of; of what stands in an object, a layout or
  // metrics, that. Empty where the text does not say.
  std::string_view of = {};
  // Of a variable that is declared: where it is known.
  Span scope = {};
  // Of a declaration: what it declares, from its keyword to its end.
  Span whole = {};
};

std::vector<Place> names_in(const syntax::File& file);

}  // namespace probe::language
