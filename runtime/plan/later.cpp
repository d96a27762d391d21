#include "runtime/plan/later.h"

#include <algorithm>

namespace probe::plan {
namespace {

constexpr std::string_view kThen = "; then: ";

}  // namespace

std::span<const LaterRecord> later_of(const Tables& tables, std::uint32_t task) {
  const auto is_before = [](const LaterRecord& later, std::uint32_t of) { return later.task < of; };
  const auto begin = std::lower_bound(tables.later.begin(), tables.later.end(), task, is_before);
  const auto end = std::lower_bound(begin, tables.later.end(), task + 1, is_before);
  return {begin, end};
}

std::vector<std::string_view> sentences_of(const Tables& tables, std::uint32_t task) {
  std::vector<std::string_view> sentences = {tables.text(tables.tasks[task].prompt)};
  for (const LaterRecord& later : later_of(tables, task))
    sentences.push_back(tables.text(later.text));
  return sentences;
}

std::string whole_instruction(const Tables& tables, std::uint32_t task) {
  std::string whole(tables.text(tables.tasks[task].prompt));
  for (const LaterRecord& later : later_of(tables, task))
    whole.append(kThen).append(tables.text(later.text));
  return whole;
}

std::string whole_instruction(std::string_view first, std::span<const std::string> later) {
  std::string whole(first);
  for (const std::string& sentence : later) whole.append(kThen).append(sentence);
  return whole;
}

}  // namespace probe::plan
