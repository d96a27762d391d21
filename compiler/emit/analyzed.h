// Files to what they mean, without bytes: for those who ask the model itself.
#pragma once

#include <cstdint>
#include <set>

#include "compiler/emit/compile.h"
#include "compiler/model/model.h"

namespace probe {

struct AnalyzedText {
  Compilation compilation;  // no plan
  sema::Model model;        // means something only where `compilation.ok`; its spans are in there
  std::set<std::uint32_t> root_files = {};  // FileId: those that were named, not used
};
// Fails as check() does (compile.h); what is wrong with the text is in the diagnostics.
Result<AnalyzedText> analyze_text(std::span<const std::string> files,
                                  const CompileOptions& options);

}  // namespace probe
