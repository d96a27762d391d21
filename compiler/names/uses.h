// Which file sees which: the graph that the loader found behind every `use`.
#pragma once

#include <set>
#include <vector>

#include "compiler/syntax/ast.h"

namespace probe::sema {

using Files = std::vector<const syntax::File*>;

// The file itself and all that it uses, by what it uses as well.
std::set<FileId> visible_files(const Files& files, const syntax::File& file);

// Whether another of the files uses it.
bool is_used(const Files& files, const syntax::File& file);

}  // namespace probe::sema
