// A plan whose bytes were changed, with its hashes made right: what a forger would send.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"
#include "runtime/plan/ids.h"

namespace probe::test {

using Bytes = std::vector<std::byte>;

// Makes the sections' hashes and the root right, as far as sections lie inside the file.
inline void seal(Bytes& bytes) {
  plan::Header header;
  if (bytes.size() < sizeof header) return;
  std::memcpy(&header, bytes.data(), sizeof header);
  header.magic = plan::kMagic;
  header.major = plan::kMajor;
  header.file_size = bytes.size();
  const std::size_t room = (bytes.size() - sizeof header) / sizeof(plan::DirectoryEntry);
  std::vector<plan::DirectoryEntry> directory(std::min<std::size_t>(header.sections, room));
  if (directory.empty()) return;
  const std::size_t size = directory.size() * sizeof(plan::DirectoryEntry);
  std::memcpy(directory.data(), bytes.data() + sizeof header, size);
  for (plan::DirectoryEntry& e : directory) {
    if (e.offset > bytes.size() || e.size > bytes.size() - e.offset) continue;
    e.sha256 = sha256(std::span<const std::byte>(bytes).subspan(e.offset, e.size)).bytes;
  }
  header.root = plan::root_hash(header, directory).bytes;
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, directory.data(), size);
}

}  // namespace probe::test
