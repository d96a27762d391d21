// Phrases beside what they denote, as rendered: a person looks whether the words fit.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::show {

struct PhraseRow {
  std::uint32_t task = 0;  // whose first start is shown
  std::string words;       // "orange object"
  std::string object;      // the identifier of what they mean, a body of the task
  std::string note;        // a second line, smaller
};

// A PNG with a row a phrase: a crop of the object in the first picture of the task's first start,
// the words beside it. Rows of one task stand together. Fails (kUsage) without rows or when
// the object is no body of the task.
Status write_phrases(const plan::Plan& plan, std::span<const PhraseRow> rows,
                     const std::string& png_path, const AssetRoot& asset_root = {});

}  // namespace probe::show
