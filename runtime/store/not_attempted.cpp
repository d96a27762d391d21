#include "runtime/store/not_attempted.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "runtime/base/printable.h"

namespace probe::store {
namespace {

constexpr std::size_t kMostTold = 3, kLongest = 300;  // reasons; characters of one

}  // namespace

bool is_not_attempted(std::string_view invalid) { return invalid.starts_with(kNotAttempted); }
bool is_not_attempted(const ResultRow& row) {
  return row.invalid && is_not_attempted(*row.invalid);
}

bool is_open(const ResultRow& row) { return row.invalid && !is_not_attempted(row); }

void NotAttempted::add(const ResultRow& row) {
  if (is_not_attempted(row)) add(std::string_view(*row.invalid).substr(kNotAttempted.size()), 1);
}

void NotAttempted::add(const NotAttempted& others) {
  for (const Reason& reason : others.reasons_) add(reason.text, reason.episodes);
}

void NotAttempted::add(std::string_view reason, int episodes) {
  count_ += episodes;
  auto at = std::ranges::find(reasons_, reason, &Reason::text);
  if (at == reasons_.end()) at = reasons_.insert(at, Reason{std::string(reason), 0});
  at->episodes += episodes;
}

std::vector<NotAttempted::Reason> NotAttempted::reasons() const {
  std::vector<Reason> sorted = reasons_;
  std::ranges::stable_sort(sorted, std::ranges::greater(), &Reason::episodes);
  return sorted;
}

std::string to_text(const NotAttempted& episodes) {
  const std::vector<NotAttempted::Reason> reasons = episodes.reasons();
  if (reasons.size() == 1) return printable(reasons.front().text, kLongest);
  std::string text;
  int others = episodes.count();
  for (std::size_t i = 0; i < reasons.size() && i < kMostTold; ++i) {
    text += fmt::format("{}{}: {}", i == 0 ? "" : "; ", reasons[i].episodes,
                        printable(reasons[i].text, kLongest));
    others -= reasons[i].episodes;
  }
  if (others > 0) text += fmt::format("; {} for other ones", others);
  return text;
}

}  // namespace probe::store
