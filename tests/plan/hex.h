// Hex dumps of plans that must be refused: lines "OFFSET: bytes", whatever no line names is zero;
// "size N" closes the file; "#" begins a comment.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/plan/format.h"
#include "runtime/plan/tables.h"

namespace probe::plan {

// Comments name the header, the directory and the section at each place, as far as they make sense.
inline std::string to_hex_dump(const std::vector<std::byte>& bytes) {
  constexpr std::size_t kRow = 32;
  const auto name_at = [&](std::size_t at) -> std::string {
    if (at == 0) return "header";
    if (at == sizeof(Header)) return "directory";
    for (std::size_t e = sizeof(Header); e + sizeof(DirectoryEntry) <= bytes.size() && e < 2048;
         e += sizeof(DirectoryEntry)) {
      DirectoryEntry entry;
      std::memcpy(&entry, bytes.data() + e, sizeof entry);
      const SectionInfo* info = find_section(entry.kind);
      if (info == nullptr) break;
      if (entry.offset == at) return info->name;
    }
    return "";
  };
  std::string out;
  for (std::size_t row = 0; row < bytes.size(); row += kRow) {
    const std::size_t end = std::min(row + kRow, bytes.size());
    std::size_t last = end;
    while (last > row && bytes[last - 1] == std::byte{0}) --last;
    const std::string name = name_at(row);
    if (!name.empty()) out += "# " + name + "\n";
    if (last == row) continue;
    out += fmt::format("{:06x}:", row);
    for (std::size_t i = row; i < last; ++i)
      out += fmt::format(" {:02x}", std::to_integer<unsigned>(bytes[i]));
    out += "\n";
  }
  return out + fmt::format("size {}\n", bytes.size());
}

// Nothing when the text is no such dump.
inline std::optional<std::vector<std::byte>> from_hex_dump(const std::string& text) {
  std::vector<std::byte> bytes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) continue;
    if (word == "size") {
      std::size_t size = 0;
      if (!(words >> size) || size < bytes.size()) return std::nullopt;
      bytes.resize(size);
      return bytes;
    }
    if (word.back() != ':') return std::nullopt;
    bytes.resize(std::stoul(word, nullptr, 16));
    while (words >> word) bytes.push_back(static_cast<std::byte>(std::stoul(word, nullptr, 16)));
  }
  return std::nullopt;  // no size: truncated itself
}

}  // namespace probe::plan
