// The names of one kind, and what is said of a name that is none of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/syntax/ast.h"

namespace probe::sema {

// The names of one kind, in the order of declaration.
class NameTable {
 public:
  explicit NameTable(std::string kind) : kind_(std::move(kind)) {}

  // The index of the new name; nothing (and P0203) when it is taken.
  std::optional<std::uint32_t> declare(const syntax::Name& name, Diagnostics& diagnostics);
  // The name that was declared last is none.
  void forget_last();
  // Nothing, and P0201 with the nearest spelling, when there is none.
  std::optional<std::uint32_t> find(const syntax::Name& name, Diagnostics& diagnostics) const;
  std::optional<std::uint32_t> peek(std::string_view text) const;

  const std::string& kind() const { return kind_; }
  const std::vector<syntax::Name>& names() const { return names_; }

 private:
  std::string kind_;
  std::vector<syntax::Name> names_;
  std::unordered_map<std::string_view, std::uint32_t> by_text_;
};

// P0201 for a name that is none of `candidates`.
Diagnostic& report_unknown(Diagnostics& diagnostics, std::string_view kind,
                           const syntax::Name& name,
                           const std::vector<std::string_view>& candidates);

}  // namespace probe::sema
