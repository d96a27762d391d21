// What files of assets hold, known once for all programs that are compiled in one call.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "runtime/base/sha256.h"

namespace probe::emit {

struct HashedFile {
  std::uint64_t byte_size = 0;
  Sha256 hash;
};
using AssetHashes = std::map<std::string, HashedFile>;  // by the file's path

}  // namespace probe::emit
