// A program as it is at one moment of typing: its files with what is not saved in them, their trees,
// the model, what is said of them, and who is called what. What editors ask is asked of it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/analyze.h"
#include "compiler/language/index.h"
#include "compiler/language/positions.h"
#include "compiler/model/model.h"
#include "compiler/syntax/parser.h"
#include "runtime/base/asset_root.h"

namespace probe::language {

// What every program of an editor shares.
struct Setting {
  AssetRoot asset_root;
  std::vector<std::string> library_folders;  // that hold `std/`
};

// What is being edited, by lexically normal path.
using Unsaved = std::map<std::string, std::string>;

class Snapshot {
 public:
  // What the file reaches by `use`, analysed without what takes long (sema::Depth). The root may be
  // a path that only `unsaved` has. Nothing where it is nowhere. `remembered`: of what it was before.
  static std::unique_ptr<Snapshot> analysed(const std::string& root, const Unsaved& unsaved,
                                            const Setting& setting,
                                            sema::Remembered* remembered = nullptr);
  // The same without a model and diagnostics: trees and names.
  static std::unique_ptr<Snapshot> parsed(const std::string& root, const Unsaved& unsaved,
                                          const Setting& setting);

  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

  const SourceSet& sources() const { return sources_; }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  const std::vector<syntax::ParseResult>& files() const { return program_.files; }
  const sema::Model& model() const { return model_; }
  // What each number should measure, in the order in which they were read.
  const std::vector<sema::WantedNumber>& wanted_numbers() const { return wants_; }
  // As the root is named; where it is.
  FileId root() const { return root_; }
  // A file of the program by its path.
  std::optional<FileId> find(std::string_view path) const;
  // Whether it is a file of the program or a table of starts that one names.
  bool reads(std::string_view path) const;
  const syntax::ParseResult* tree(FileId file) const;
  std::string_view text(FileId file) const { return sources_.file(file).text(); }
  const std::string& path(FileId file) const { return sources_.file(file).name(); }
  // Both are made when they are asked for.
  const Index& index() const;
  const Lines& lines(FileId file) const;

  const sema::Task* task(std::string_view name) const;
  // The declaration at a place; null between them.
  const syntax::Decl* decl_at(FileId file, std::uint32_t offset) const;
  // The words of the tree that a place lies in.
  Range range(const Span& span) const { return lines(span.file).range(span.begin, span.end); }

 private:
  Snapshot() = default;
  static std::unique_ptr<Snapshot> read(const std::string& root, const Unsaved& unsaved,
                                        const Setting& setting);

  SourceSet sources_;
  Diagnostics diagnostics_;
  syntax::Program program_;
  sema::Model model_;
  std::vector<sema::WantedNumber> wants_;
  FileId root_;
  mutable std::unique_ptr<Index> index_;
  mutable std::map<FileId, std::unique_ptr<Lines>> lines_;
};

}  // namespace probe::language
