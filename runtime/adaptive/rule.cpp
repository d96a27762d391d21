#include "runtime/adaptive/rule.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

#include "runtime/base/printable.h"
#include "runtime/store/run_record.h"

namespace probe::adaptive {
namespace {

constexpr std::size_t kLongestShown = 200;
constexpr std::string_view kWidth = "width ", kDecidedWord = "decided-against ";
constexpr std::string_view kOfEach = store::kOfEachTask, kOfAll = "of all tasks";
constexpr std::string_view kDecidedText = "decided against `", kOutcomes = "` (outcomes ";

Failure usage(const std::string& text, const std::string& why) {
  return {Fault::kUsage,
          "--until `" + text + "` " + why +
              "; it is \"width 10%\" (of each task), \"width 5% of all\", \"decided-against DIR\" or "
              "none",
          ""};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// "10 %", "2.5%", in percent.
std::optional<double> percent_of(std::string_view text) {
  text = trimmed(text);
  if (!text.ends_with('%')) return std::nullopt;
  text.remove_suffix(1);
  text = trimmed(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Result<Rule> parse_rule(const std::string& text) {
  Rule rule;
  const std::string_view all = trimmed(text);
  if (all.starts_with(kDecidedWord)) {
    rule.kind = Rule::Kind::kDecided;
    rule.dir = std::string(trimmed(all.substr(kDecidedWord.size())));
    if (rule.dir.empty()) return usage(text, "names no folder to compare with");
    return rule;
  }
  if (!all.starts_with(kWidth)) return usage(text, "is no rule");
  const std::string_view behind = all.substr(kWidth.size());
  const auto percent = behind.find('%');
  if (percent == behind.npos) return usage(text, "has no width in percent");
  const std::string_view of = trimmed(behind.substr(percent + 1));
  if (of == "of all" || of == kOfAll) {
    rule.kind = Rule::Kind::kAllTasks;
  } else if (!of.empty() && of != kOfEach && of != "of each") {
    return usage(text, "is of neither each task nor all");
  }
  const auto width = percent_of(behind.substr(0, percent + 1));
  if (!width) return usage(text, "has no width in percent");
  if (!(*width > 0)) return usage(text, "asks for an interval without width, which only all episodes give");
  if (!(*width < 100)) return usage(text, "asks for an interval that no episode is needed for");
  rule.points = *width;
  return rule;
}

std::string to_text(const Rule& rule) {
  if (rule.kind == Rule::Kind::kDecided)
    return std::string(kDecidedText) + rule.against + std::string(kOutcomes) + rule.outcomes + ")";
  return fmt::format("{}{} % {}", kWidth, rule.points,
                     rule.kind == Rule::Kind::kEachTask ? kOfEach : kOfAll);
}

std::string in_words(const std::string& until) {
  const auto outcomes = until.rfind(kOutcomes);
  // Its first character ends the name.
  return outcomes == until.npos ? until : until.substr(0, outcomes + 1);
}

Result<Rule> rule_from_text(const std::string& text, const std::string& where) {
  if (text == store::kBySearch)
    return Failure{Fault::kUsage,
                   "a search chose its episodes by what it found, so its rates are those of no suite: "
                   "`vlaprobe search show DIR` says what was found, `results --csv` lists episodes",
                   where};
  const Failure unknown{Fault::kStore,
                        "stops by a rule that this program does not know: `" + printable(text, kLongestShown) + "`",
                        where};
  if (text.starts_with(kDecidedText)) {
    Rule rule;
    rule.kind = Rule::Kind::kDecided;
    const auto outcomes = text.rfind(kOutcomes);
    if (outcomes == text.npos || !text.ends_with(')')) return unknown;
    rule.against = text.substr(kDecidedText.size(), outcomes - kDecidedText.size());
    rule.outcomes = text.substr(outcomes + kOutcomes.size());
    rule.outcomes.pop_back();
    return rule;
  }
  auto rule = parse_rule(text);
  if (!rule || to_text(*rule) != text) return unknown;
  return rule;
}

Sha256 rank_of(Rule::Kind kind, std::string_view task, const Sha256& episode_id, int seed) {
  Hasher hasher;
  hasher.text("until").text(task).hash(episode_id);
  if (kind != Rule::Kind::kDecided)
    hasher.u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(seed)));
  return hasher.finish();
}

}  // namespace probe::adaptive
