// The analysis as a whole: parsed files in, the model and diagnostics out.
#pragma once

#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/model.h"
#include "compiler/names/reporter.h"
#include "compiler/syntax/ast.h"
#include "runtime/base/asset_root.h"

namespace probe::sema {

// In: trees, a file after the files it uses. Out: the model, which means something only when
// `diagnostics` has no errors. The order: names are collected, repeats refused, the model defined
// (define/define.h), then checked (check/check.h); at last `@allow` decides what is said.
// `asset_root` is where URDF files are looked up. `roots`: the files named by the user rather than
// by `use`; empty means all.
Model analyze(const SourceSet& sources, const std::vector<const syntax::File*>& files,
              const AssetRoot& asset_root, Diagnostics& diagnostics,
              std::vector<FileId> roots = {}, const Depth& depth = {});

}  // namespace probe::sema
