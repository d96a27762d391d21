#include "compiler/names/uses.h"

#include <algorithm>

namespace probe::sema {
namespace {

// Every `use` of the file that was found.
std::vector<FileId> used_by(const syntax::File& file) {
  std::vector<FileId> used;
  for (const syntax::Decl& decl : file.decls) {
    const auto* use = std::get_if<syntax::UseDecl>(&decl.node);
    if (use != nullptr && !use->file.is_none()) used.push_back(use->file);
  }
  return used;
}

}  // namespace

std::set<FileId> visible_files(const Files& files, const syntax::File& file) {
  std::set<FileId> visible;
  std::vector<FileId> open = {file.id};
  while (!open.empty()) {
    const FileId at = open.back();
    open.pop_back();
    if (!visible.insert(at).second) continue;
    const auto tree = std::find_if(files.begin(), files.end(),
                                   [&](const syntax::File* known) { return known->id == at; });
    if (tree == files.end()) continue;
    const std::vector<FileId> used = used_by(**tree);
    open.insert(open.end(), used.begin(), used.end());
  }
  return visible;
}

bool is_used(const Files& files, const syntax::File& file) {
  return std::any_of(files.begin(), files.end(), [&](const syntax::File* other) {
    const std::vector<FileId> used = used_by(*other);
    return other->id != file.id && std::find(used.begin(), used.end(), file.id) != used.end();
  });
}

}  // namespace probe::sema
