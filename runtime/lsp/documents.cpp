#include "runtime/lsp/documents.h"

#include <algorithm>

namespace probe::lsp {

void Documents::open(const std::string& path, Document document) {
  all_[path] = std::move(document);
}

bool Documents::change(const std::string& path, std::int64_t version,
                       const std::vector<Change>& changes) {
  const auto found = all_.find(path);
  if (found == all_.end()) return false;
  found->second.version = version;
  std::string& text = found->second.text;
  for (const Change& change : changes) {
    if (!change.range) {
      text = change.text;
      continue;
    }
    const language::Lines lines(text);
    const std::uint32_t a = lines.offset(change.range->begin);
    const std::uint32_t b = lines.offset(change.range->end);
    const std::uint32_t begin = std::min(a, b), end = std::max(a, b);
    text.replace(begin, end - begin, change.text);
  }
  return true;
}

bool Documents::close(const std::string& path) { return all_.erase(path) > 0; }

const Document* Documents::find(const std::string& path) const {
  const auto found = all_.find(path);
  return found == all_.end() ? nullptr : &found->second;
}

std::map<std::string, std::string> Documents::texts() const {
  std::map<std::string, std::string> out;
  for (const auto& [path, document] : all_) out.emplace(path, document.text);
  return out;
}

}  // namespace probe::lsp
