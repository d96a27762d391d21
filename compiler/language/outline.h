// A file as a tree of what it declares, and what of it can be folded away.
#pragma once

#include <string>
#include <vector>

#include "compiler/language/snapshot.h"

namespace probe::language {

struct OutlineItem {
  std::string name;
  std::string detail;  // "like put_base"
  Kind kind = Kind::kTask;
  Span whole, at;  // `at`: its name, within `whole`
  std::vector<OutlineItem> children;
};
std::vector<OutlineItem> outline(const Snapshot& snapshot, FileId file);

enum class FoldKind : std::uint8_t { kBlock, kComment, kUses };
struct Fold {
  std::uint32_t first = 0, last = 0;  // lines
  FoldKind kind = FoldKind::kBlock;
};
// Of two lines and more.
std::vector<Fold> folds(const Snapshot& snapshot, FileId file);

}  // namespace probe::language
