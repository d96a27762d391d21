// What FORMAT.md allows to do to a plan without asking its author.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "runtime/plan/format.h"
#include "runtime/plan/ids.h"

namespace probe::plan {

// The same plan without its ignorable sections: same root, same ids. `bytes` is a verified plan.
inline std::vector<std::byte> strip_sources(std::span<const std::byte> bytes) {
  Header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::vector<DirectoryEntry> directory;
  std::vector<std::span<const std::byte>> sections;
  for (std::uint32_t i = 0; i < header.sections; ++i) {
    DirectoryEntry entry;
    std::memcpy(&entry, bytes.data() + sizeof header + i * sizeof entry, sizeof entry);
    if ((entry.flags & kIgnorable) != 0) continue;
    sections.push_back(bytes.subspan(entry.offset, entry.size));
    directory.push_back(entry);
  }
  std::uint64_t end = sizeof header + directory.size() * sizeof(DirectoryEntry);
  for (DirectoryEntry& entry : directory) {
    entry.offset = align_up(end);
    end = entry.offset + entry.size;
  }
  header.sections = static_cast<std::uint32_t>(directory.size());
  header.file_size = end;
  std::vector<std::byte> out(end);
  std::memcpy(out.data(), &header, sizeof header);
  std::memcpy(out.data() + sizeof header, directory.data(),
              directory.size() * sizeof(DirectoryEntry));
  for (std::size_t i = 0; i < sections.size(); ++i)
    std::memcpy(out.data() + directory[i].offset, sections[i].data(), sections[i].size());
  return out;
}

}  // namespace probe::plan
