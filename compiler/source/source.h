// Source texts, byte spans and line numbers: text in, spans out. Knows nothing of the language.
// A SourceFile never moves or changes once it is in its SourceSet, so views of its text live as
// long as the set.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe {

// Index of a file in its SourceSet.
struct FileId {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;

  bool is_none() const { return value == kNone; }
  auto operator<=>(const FileId&) const = default;
};

// Bytes [begin, end) of one file. A span of length zero is a place between two bytes.
struct Span {
  FileId file;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  std::uint32_t size() const { return end - begin; }
  bool is_none() const { return file.is_none(); }
  auto operator<=>(const Span&) const = default;
};
static_assert(sizeof(Span) == 12);

// From the start of `first` to the end of `last`; both in one file.
inline Span join(const Span& first, const Span& last) {
  return {first.file, first.begin, last.end};
}

// Whether `inner` lies within `outer`.
inline bool is_within(const Span& inner, const Span& outer) {
  return inner.file == outer.file && inner.begin >= outer.begin && inner.end <= outer.end;
}

// Both from 1. A column counts characters (code points), not bytes: what editors show.
struct LineColumn {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
  auto operator<=>(const LineColumn&) const = default;
};

// Larger texts are kept only up to this size and refused by the parser; spans stay far below 32
// bits.
inline constexpr std::size_t kMaxSourceBytes = std::size_t{16} << 20;

class SourceFile {
 public:
  SourceFile(std::string name, std::string text);

  // As the user wrote it, or relative to the file that names it; shown in diagnostics.
  const std::string& name() const { return name_; }
  // The bytes as they are on disk: byte order mark, carriage returns and all.
  std::string_view text() const { return text_; }
  std::string_view text(const Span& span) const;

  std::uint32_t line_count() const { return static_cast<std::uint32_t>(line_starts_.size()); }
  // Line from 1; without its line ending.
  std::string_view line(std::uint32_t line) const;
  std::uint32_t line_start(std::uint32_t line) const { return line_starts_[line - 1]; }
  // An offset past the end counts as the end.
  std::uint32_t line_of(std::uint32_t offset) const;
  LineColumn line_column(std::uint32_t offset) const;

 private:
  std::string name_;
  std::string text_;
  std::vector<std::uint32_t> line_starts_;  // ascending; the first is 0; "\n" ends a line
};

class SourceSet {
 public:
  FileId add(std::string name, std::string text);
  // Reads the file at `path` (at most kMaxSourceBytes + 1 bytes of it); the name shown is `path`. A
  // file that is already in the set under this name is not read again.
  Result<FileId> load(const std::string& path);

  std::optional<FileId> find(std::string_view name) const;
  const SourceFile& file(FileId id) const;
  std::size_t size() const { return files_.size(); }

  std::string_view text(const Span& span) const { return file(span.file).text(span); }

 private:
  std::deque<SourceFile> files_;  // a deque: files keep their address
};

}  // namespace probe
