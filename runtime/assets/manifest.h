// manifest.json of an asset folder: every file with its size and SHA-256. What made the folder
// vouches by it that the files were read and found good.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::assets {

struct ManifestEntry {
  std::uint64_t bytes = 0;
  std::string sha256;  // 64 hexadecimal digits
  std::string source;  // what it was made from, for people; may be empty
};

struct Manifest {
  std::map<std::string, ManifestEntry, std::less<>> files;  // by path relative to the folder

  const ManifestEntry* find(std::string_view path) const;
  std::string to_json() const;  // sorted by path
};

// Of a folder without a manifest: empty. Fails (kAsset, where = the file) on one that is not
// JSON of this form.
Result<Manifest> read_manifest(const std::string& folder);

}  // namespace probe::assets
