// Where the files lie that plans name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe {

// One folder or several, looked through in order. A *thing* is whole in one of them, the first that
// has it: `objects/mug` with all its meshes, `robots/arm`, `textures/oak.png`; so no picture of one
// mug is felt as another.
class AssetRoot {
 public:
  AssetRoot() = default;
  // One folder is what most callers have.
  AssetRoot(std::string folder);  // NOLINT(google-explicit-constructor)
  AssetRoot(const char* folder);  // NOLINT(google-explicit-constructor)
  // Named by somebody, so they come before what lies beside a text.
  static AssetRoot chosen(const std::vector<std::string>& folders);
  // Found by itself: what lies beside a text comes before it.
  static AssetRoot found(const std::vector<std::string>& folders);

  bool empty() const { return folders_.empty(); }
  std::vector<std::string> folders() const;
  // "`a`", "`a`, `b`": those that were named or found, without what lies beside texts.
  std::string text() const;
  // The folder that `path` is in; where it is nowhere, the first, and "" of none.
  const std::string& holder(std::string_view path) const;
  // holder(path)/path
  std::string file(std::string_view path) const;

  // With the folders of these texts (or plans), and `assets` in each: models that lie beside their
  // text need no naming.
  AssetRoot beside(std::span<const std::string> texts) const;
  // For somebody who does not know the texts: without the folders beside them that hold none of
  // these files, and nothing where only what is found by itself is left.
  AssetRoot kept_for(std::span<const std::string> paths) const;

  // Of a file that none of them has: the words that name a folder which does, be it the program's own
  // or one that lies beside a text under another name; empty where there is none.
  std::string advice(std::string_view path) const;

  // Fails (kAsset, where = the folder) naming a folder that is not there.
  Status check() const;

 private:
  enum class Kind { kChosen, kBeside, kFound };
  struct Folder {
    std::string path;
    Kind kind = Kind::kChosen;
  };
  void add(std::string path, Kind kind);
  std::vector<Folder> folders_;  // by kind, as declared
};

// The folders that the plan's asset paths are relative to: `chosen` if not empty, else the
// environment's VLAPROBE_ASSETS (several behind one another as in PATH), else `assets` beside the
// folder of the program (or of our library, in somebody else's program), else that of the source
// tree it was built from. Fails (kAsset) naming every place it looked at.
Result<AssetRoot> find_asset_root(const AssetRoot& chosen = {});

}  // namespace probe
