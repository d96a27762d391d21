// What is said of a place when it is pointed at: Markdown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/language/snapshot.h"

namespace probe::language {

struct Hover {
  Span span;
  std::string text;
};
// `said`: the diagnostics shown of the file, whose essays are told at their places.
std::optional<Hover> hover(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                           const std::vector<const Diagnostic*>& said);

// The declaration as it is written, cut to a few lines, with its documentation. Empty when the text
// declares none.
std::string declaration_text(const Snapshot& snapshot, const Place& declaration);

// Where a name is declared: of what `derive` makes, there. Of members and phrases those of their
// owner before others.
std::vector<Span> definitions(const Snapshot& snapshot, FileId file, std::uint32_t offset);

}  // namespace probe::language
