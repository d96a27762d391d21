// The text that a search begins with: its space, and the task that varies in it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compiler/emit/analyzed.h"
#include "compiler/geometry/part_boxes.h"
#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::search {

struct TextOptions {
  std::string file;     // Probe text
  std::string space;    // its name; empty: the only one that the text declares
  AssetRoot assets;     // empty: found by itself
  std::string library;  // as of compile::FilesRequest
};

// Never moves: starts of tasks are views into the model.
class BaseTask {
 public:
  // Fails (kUsage) on a text with mistakes, which `said` then has as text, on one without a space,
  // and on a name that none has.
  static Result<std::unique_ptr<BaseTask>> open(const TextOptions& options, std::string& said);

  const TextOptions& options() const { return options_; }
  const sema::Model& model() const { return text_.model; }
  const sema::Space& space() const { return *space_; }
  const sema::Task& task() const { return text_.model.tasks[space_->of]; }
  // Whether nothing of the text is out of the picture: else points of it may be as well.
  bool is_seen() const { return is_seen_; }
  // What clutter keeps clear of.
  const sema::PartBoxes& ways() const { return ways_; }
  // Where files of a text at `file` that uses this one are looked for.
  AssetRoot assets_beside(const std::string& file) const {
    return text_.compilation.asset_root.beside(std::span(&file, 1));
  }
  // The .probe files that the text is made of: their names and bytes, hashed.
  const std::string& hash() const { return hash_; }

 private:
  BaseTask(TextOptions options, AnalyzedText text)
      : options_(std::move(options)), text_(std::move(text)) {}

  TextOptions options_;
  AnalyzedText text_;
  const sema::Space* space_ = nullptr;
  std::string hash_;
  sema::PartBoxes ways_;
  bool is_seen_ = true;
};

}  // namespace probe::search
