// A symbol under another name, in every file that speaks of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/language/snapshot.h"
#include "runtime/base/result.h"

namespace probe::language {

// A place of a file, by its path.
struct FilePlace {
  std::string path;
  Range range;
  Span span;
  bool declares = false;
  auto operator<=>(const FilePlace&) const = default;
};

// All places of what the name at a place of `snapshot` stands for: in it, and in other programs
// that have its declaration from the same file. In the order of paths and places, each once.
std::vector<FilePlace> references(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                                  const std::vector<const Snapshot*>& others);

// The name that would be renamed. Fails (kUsage) where nothing is, or nothing that a text declares.
Result<Span> renamed_span(const Snapshot& snapshot, FileId file, std::uint32_t offset);

// What the name at a place stands for. Fails (kUsage) where nothing does.
Result<Symbol> symbol_at(const Snapshot& snapshot, FileId file, std::uint32_t offset);

// Whether a symbol may be called so in a program. Fails (kUsage) saying why not: no name, a word of
// the language, or a name that stands for anything there, of whatever kind and scope.
Status check_new_name(const Snapshot& snapshot, const Symbol& symbol, const std::string& name);

// What texts that are edited so say wrong and the present ones do not, as where a `derive` makes names of
// the name that was changed. Empty when there is nothing.
std::string new_mistake(const Snapshot& snapshot, const Symbol& symbol, const std::string& name,
                        const Unsaved& edited, const Setting& setting);

}  // namespace probe::language
