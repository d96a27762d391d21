// The table of codes, the collector, and the nearest spelling.
#include "compiler/diag/diagnostic.h"

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/base/spelling.h"

namespace probe {
namespace {

constexpr auto kSituations = std::to_array<Code>({
#define PROBE_SITUATION(code, name, meaning) Code::code,
#include "compiler/diag/codes.def"
});

constexpr auto kCodes = std::to_array<CodeInfo>({
#define PROBE_CODE(code, severity, slug, title) \
  {Code::code, #code, Severity::severity, slug, title},
#include "compiler/diag/codes.def"
});

}  // namespace

const CodeInfo& info(Code code) { return kCodes[static_cast<std::size_t>(code)]; }

Code code_of(Situation situation) { return kSituations[static_cast<std::size_t>(situation) - 1]; }

std::string_view to_text(Severity severity) {
  return severity == Severity::kError ? "error" : "warning";
}

std::optional<Code> code_from_text(std::string_view text) {
  for (const CodeInfo& entry : kCodes) {
    if (entry.text == text) return entry.code;
  }
  return std::nullopt;
}

std::optional<Code> code_from_slug(std::string_view slug) {
  if (slug.empty()) return std::nullopt;
  for (const CodeInfo& entry : kCodes) {
    if (entry.slug == slug) return entry.code;
  }
  return std::nullopt;
}

std::vector<Code> all_codes() {
  std::vector<Code> codes;
  for (const CodeInfo& entry : kCodes) codes.push_back(entry.code);
  return codes;
}

Diagnostic& Diagnostics::report(Code code, const Span& primary, std::string message) {
  Diagnostic diagnostic;
  diagnostic.code = code;
  diagnostic.severity = info(code).severity;
  diagnostic.message = std::move(message);
  diagnostic.primary = primary;
  return add(std::move(diagnostic));
}

Diagnostic& Diagnostics::report(Situation situation, const Span& primary, std::string message) {
  Diagnostic& diagnostic = report(code_of(situation), primary, std::move(message));
  diagnostic.situation = situation;
  return diagnostic;
}

Diagnostic& Diagnostics::add(Diagnostic diagnostic) {
  return items_.emplace_back(std::move(diagnostic));
}

std::size_t Diagnostics::error_count() const {
  const auto is_error = [](const Diagnostic& item) { return item.severity == Severity::kError; };
  for (; counted_ + kUnsettled < items_.size(); ++counted_)
    counted_errors_ += is_error(items_[counted_]) ? 1 : 0;
  return counted_errors_ +
         static_cast<std::size_t>(std::count_if(
             items_.begin() + static_cast<std::ptrdiff_t>(counted_), items_.end(), is_error));
}

std::vector<const Diagnostic*> Diagnostics::in_source_order() const {
  std::vector<const Diagnostic*> sorted;
  sorted.reserve(items_.size());
  for (const Diagnostic& item : items_) sorted.push_back(&item);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic* a, const Diagnostic* b) {
    return a->primary < b->primary;
  });
  return sorted;
}

std::size_t edit_distance(std::string_view a, std::string_view b) { return spelling_edits(a, b); }

std::optional<std::string_view> nearest(std::string_view name,
                                        std::span<const std::string_view> candidates) {
  const std::string_view* near = nearest_spelling(name, candidates);
  if (near == nullptr) return std::nullopt;
  return *near;
}

}  // namespace probe
