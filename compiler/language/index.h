// Which name stands for what, in all files of a program: declarations and uses of every symbol.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/language/names_in.h"
#include "compiler/source/source.h"
#include "compiler/syntax/parser.h"

namespace probe::language {

// What a name stands for. Names of one kind are one name wherever they are declared: a phrase
// `by_color` of two objects is one symbol, for whoever refers by it may mean either.
struct Symbol {
  Kind kind = Kind::kObject;
  std::string name;
  std::string of;   // of a value its attribute
  Span scope = {};  // of a variable
  bool operator==(const Symbol&) const = default;
};

class Index {
 public:
  // The trees are not needed any more, their sources are.
  explicit Index(std::span<const syntax::ParseResult> files);

  // In the order of the text.
  const std::vector<Place>& places(FileId file) const;
  // The name that begins, ends or lies there.
  const Place* at(FileId file, std::uint32_t offset) const;

  // Nothing where nothing of that name is declared that could stand there.
  std::optional<Symbol> symbol(const Place& place) const;
  // Files in their order, then by place. Roles and measures of the language have none.
  std::vector<const Place*> declarations(const Symbol& symbol) const;
  std::vector<const Place*> all(const Symbol& symbol) const;
  // Of these kinds, each name once, in the order of the files.
  std::vector<const Place*> declared(Kinds kinds) const;

  // Whether the name is the language's own: `source`, `target`, what can be measured.
  static bool is_built_in(Kind kind, std::string_view name);

 private:
  bool is_declared(Kind kind, const Place& place) const;
  const Place* variable(const Place& place) const;

  std::vector<std::pair<FileId, std::vector<Place>>> files_;
  std::unordered_map<std::string_view, std::vector<const Place*>> declarations_;  // by name
};

}  // namespace probe::language
