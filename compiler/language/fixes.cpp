#include "compiler/language/fixes.h"

#include <algorithm>

namespace probe::language {
namespace {

bool touches(const Span& a, const Span& b) {
  return a.begin < b.end && b.begin < a.end ? true : a.begin == b.begin;
}

}  // namespace

std::vector<Replacement> all_fixes(const std::vector<const Diagnostic*>& diagnostics,
                                   FileId file) {
  std::vector<Replacement> out;
  for (const Diagnostic* diagnostic : diagnostics) {
    if (!diagnostic->fix) continue;
    const auto& parts = diagnostic->fix->replacements;
    const bool fits = std::ranges::all_of(parts, [&](const Replacement& part) {
      return part.span.file == file && std::ranges::none_of(out, [&](const Replacement& known) {
               return touches(known.span, part.span);
             });
    });
    if (fits) out.insert(out.end(), parts.begin(), parts.end());
  }
  std::ranges::sort(out, {}, [](const Replacement& part) { return part.span.begin; });
  return out;
}

std::string applied(std::string_view text, std::vector<Replacement> replacements) {
  std::ranges::sort(replacements, {}, [](const Replacement& part) { return part.span.begin; });
  std::string out;
  std::size_t at = 0;
  for (const Replacement& part : replacements) {
    const std::size_t begin = std::clamp<std::size_t>(part.span.begin, at, text.size());
    out += text.substr(at, begin - at);
    out += part.text;
    at = std::clamp<std::size_t>(part.span.end, begin, text.size());
  }
  return out += text.substr(at);
}

}  // namespace probe::language
