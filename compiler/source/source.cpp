// Files in memory and where their lines start. Reading is the only contact with the outside.
#include "compiler/source/source.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/stat.h>

#include "runtime/base/check.h"
#include "runtime/base/file.h"
#include "runtime/base/utf8.h"

namespace probe {

SourceFile::SourceFile(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  if (text_.size() > kMaxSourceBytes + 1) text_.resize(kMaxSourceBytes + 1);
  line_starts_.push_back(0);
  const char* const begin = text_.data();
  const char* const end = begin + text_.size();
  for (const char* at = begin; at != end;) {
    const void* newline = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
    if (newline == nullptr) break;
    at = static_cast<const char*>(newline) + 1;
    line_starts_.push_back(static_cast<std::uint32_t>(at - begin));
  }
}

std::string_view SourceFile::text(const Span& span) const {
  const std::size_t begin = std::min<std::size_t>(span.begin, text_.size());
  const std::size_t end = std::clamp<std::size_t>(span.end, begin, text_.size());
  return text().substr(begin, end - begin);
}

std::string_view SourceFile::line(std::uint32_t line) const {
  const std::size_t begin = line_starts_[line - 1];
  std::size_t end = line < line_count() ? line_starts_[line] - 1 : text_.size();
  if (end > begin && text_[end - 1] == '\r') --end;
  return text().substr(begin, end - begin);
}

std::uint32_t SourceFile::line_of(std::uint32_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return static_cast<std::uint32_t>(after - line_starts_.begin());
}

LineColumn SourceFile::line_column(std::uint32_t offset) const {
  offset = static_cast<std::uint32_t>(std::min<std::size_t>(offset, text_.size()));
  const std::uint32_t line = line_of(offset);
  const std::string_view before =
      text().substr(line_starts_[line - 1], offset - line_starts_[line - 1]);
  const auto continuations = std::count_if(before.begin(), before.end(), is_utf8_tail);
  const bool marked =
      line == 1 && before.starts_with("\xef\xbb\xbf");  // a byte order mark is no character
  const std::size_t characters =
      before.size() - static_cast<std::size_t>(continuations) - (marked ? 1 : 0);
  return {line, static_cast<std::uint32_t>(characters) + 1};
}

FileId SourceSet::add(std::string name, std::string text) {
  files_.emplace_back(std::move(name), std::move(text));
  return {static_cast<std::uint32_t>(files_.size() - 1)};
}

Result<FileId> SourceSet::load(const std::string& path) {
  if (const std::optional<FileId> known = find(path)) return *known;
  // A folder opens and cannot be read, a device may never end: only regular files are sources.
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    return Failure{Fault::kIo, std::string("cannot read: ") + std::strerror(errno), path};
  }
  if (!S_ISREG(status.st_mode)) return Failure{Fault::kIo, "cannot read: not a regular file", path};
  // One byte more than a source may have, so that the lexer sees that it has more.
  auto text = read_file(path, {.most = kMaxSourceBytes + 1, .only_begin = true});
  if (!text) return Failure{Fault::kIo, "cannot read: " + text.failure().message, path};
  return add(path, std::move(*text));
}

std::optional<FileId> SourceSet::find(std::string_view name) const {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (files_[i].name() == name) return FileId{static_cast<std::uint32_t>(i)};
  }
  return std::nullopt;
}

const SourceFile& SourceSet::file(FileId id) const {
  PROBE_CHECK(id.value < files_.size(), "a span or file id of another source set");
  return files_[id.value];
}

}  // namespace probe
