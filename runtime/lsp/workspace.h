// The programs that the open texts belong to, brought up to date when they are asked for; and the
// other texts of the folders that an editor works in.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/define/remembered.h"
#include "compiler/language/snapshot.h"
#include "runtime/base/asset_root.h"
#include "runtime/lsp/documents.h"

namespace probe::lsp {

// What is said of a program.
struct Program {
  std::string root;
  std::unique_ptr<language::Snapshot> now;
  std::unique_ptr<sema::Remembered> remembered;  // for the next
  // What only the whole `check` finds (reach, travels, meshes, files of assets), in spans of `now`.
  std::deque<Diagnostic> slow;
  bool is_checked = false;  // `slow` is of this text; else it is what is left of the one before

  // All of it, of one file.
  std::vector<const Diagnostic*> said(FileId file) const;
};

// What a whole `check` of a program said, and of which files by their paths.
struct WholeCheck {
  std::deque<Diagnostic> items;
  std::vector<std::string> paths;  // by FileId
};
// The whole check with this machine's assets; nothing when it was stopped or failed.
std::optional<WholeCheck> check_whole(const std::string& root, const language::Unsaved& unsaved,
                                      const AssetRoot& assets, const std::string& library,
                                      const std::atomic<bool>& stop);

class Workspace {
 public:
  explicit Workspace(language::Setting setting) : setting_(std::move(setting)) {}

  Documents documents;
  std::vector<std::string> folders;

  const language::Setting& setting() const { return setting_; }

  // A text changed, in the editor or on the disk; empty: anything may have.
  void touch(const std::string& path);
  // Every program as it is now. Whether any of them was read anew.
  bool refresh();
  // What was in their places before, since the last call: whoever asked may let go of it later.
  std::shared_ptr<void> take_old();
  const std::vector<std::unique_ptr<Program>>& programs() const { return programs_; }
  // The program and the file of an open text; null for any other.
  struct Found {
    Program* program = nullptr;
    FileId file;
  };
  Found find(const std::string& path);

  // Takes what a whole check said, of the program as it is now.
  static void take(Program& program, const WholeCheck& checked);

  // Every program that is open, and those of texts in the folders that no open text reaches: of
  // these trees and names alone.
  std::vector<const language::Snapshot*> others();
  // Why `others` lacks texts of the folders; empty when it has them all.
  const std::string& missed() const { return missed_; }
  // Whether a file may be changed: it lies in a folder of the editor or is open.
  bool is_ours(const std::string& path) const;

 private:
  std::vector<std::string> texts_in_folders();
  void carry_over(const Program& before, Program& after) const;

  language::Setting setting_;
  std::vector<std::unique_ptr<Program>> programs_;
  std::set<std::string> touched_;
  bool is_all_touched_ = false;
  std::vector<std::unique_ptr<Program>> old_;
  std::vector<std::unique_ptr<language::Snapshot>> others_;
  bool has_others_ = false;
  std::string missed_;
};

}  // namespace probe::lsp
