// What can stand at a place: names of the kinds that the grammar takes there, its words, units of
// what a number should measure, phrases with what they mean in the task.
#pragma once

#include <string>
#include <vector>

#include "compiler/language/snapshot.h"

namespace probe::language {

struct Suggestion {
  std::string label;
  std::string detail;         // "object", "means `carrot` alone"
  std::string documentation;  // Markdown
  int item_kind = 0;          // CompletionItemKind of the protocol
  std::uint32_t rank = 0;     // the lowest first
};
struct Suggestions {
  Span replaced;  // the word that is being written, perhaps empty
  std::vector<Suggestion> items;
};
Suggestions complete(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                     const Setting& setting);

}  // namespace probe::language
