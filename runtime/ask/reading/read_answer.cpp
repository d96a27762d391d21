#include "runtime/ask/reading/read_answer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "runtime/ask/reading/doubt_words.h"
#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_places.h"
#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {
namespace {

bool is_gap(char c) { return c == ' ' || c == '\n' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_gap(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_gap(text.back())) text.remove_suffix(1);
  return text;
}

std::span<const ReadRule> rules_of(plan::QuestionForm form) {
  switch (form) {
    case plan::QuestionForm::kChoice:
      return choice_rules();
    case plan::QuestionForm::kYesNo:
      return yesno_rules();
    case plan::QuestionForm::kNumber:
      return number_rules();
    case plan::QuestionForm::kPoint:
      return point_rules();
    case plan::QuestionForm::kFree:
      return free_rules();
  }
  return {};
}

constexpr int kDeepest = 3;  // a box in a tag in JSON

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> sentences_of(std::span<const Token> tokens) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= tokens.size(); ++at) {
    if (at < tokens.size() && !tokens[at].is_end()) continue;
    if (at > begin) out.emplace_back(begin, at);
    begin = at + 1;
  }
  return out;
}

std::vector<std::pair<std::size_t, std::size_t>> lines_of(std::span<const Token> tokens) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= tokens.size(); ++at) {
    if (at < tokens.size() && tokens[at].kind != TokenKind::kBreak) continue;
    if (at > begin) out.emplace_back(begin, at);
    begin = at + 1;
  }
  return out;
}

bool is_denied(std::span<const Token> tokens, std::size_t at) {
  constexpr std::size_t kFar = 30;  // tokens
  const std::size_t last = at > kFar ? at - kFar : 0;
  while (at > last) {
    const Token& token = tokens[--at];
    if (token.is_end() || token.is_sign(';') || token.is_sign(':') || token.is("but")) return false;
    // "The others are wrong, so it is B" concludes.
    if (token.is("so") && at > 0 && tokens[at - 1].is_sign(',')) return false;
    if (is_against(tokens, at, kSaysNot)) return true;
  }
  return false;
}

namespace {

// Raised, lowered and circled digits.
bool has_superscript(std::string_view text) {
  constexpr auto kSigns = std::to_array<std::string_view>(
      {"\u00b2", "\u00b3", "\u00b9", "\u2070", "\u2074", "\u2075", "\u2076", "\u2077",
       "\u2078", "\u2079", "\u2080", "\u2081", "\u2082", "\u2083", "\u2084", "\u2085",
       "\u2086", "\u2087", "\u2088", "\u2089", "\u2460", "\u2461", "\u2462", "\u2463",
       "\u2464", "\u2465", "\u2466", "\u2467", "\u2468"});
  return std::any_of(kSigns.begin(), kSigns.end(),
                     [&](std::string_view sign) { return text.find(sign) != text.npos; });
}

// Whether a place that says where an answer ends has ended.
bool has_whole_place(const ReadContext& context, std::string_view text) {
  for (const Place& place : answer_places()) {
    if (!place.says_its_end) continue;
    const auto parts = place.find(context, text);
    if (!parts.empty())
      return std::ranges::all_of(parts, [](const FoundPart& part) { return part.closed; });
  }
  return false;
}

}  // namespace

bool is_cut(std::string_view finish) { return finish == "length" || finish == "content_filter"; }

AnswerReader::AnswerReader(ReadContext context)
    : context_(std::move(context)), names_(context_.options, context_.question) {}

Reading AnswerReader::read_part(std::string_view text, int depth) const {
  text = trimmed(text);
  if (text.empty()) return {.verdict = Verdict::kEmpty, .rule = "blank"};
  // A sentence is read as it stands.
  const bool is_free = context_.form == plan::QuestionForm::kFree;
  for (const Place& place : answer_places()) {
    if (depth == kDeepest || (is_free && !place.says_its_end)) break;
    const std::vector<FoundPart> parts = place.find(context_, text);
    // A part that is the text itself would be found again.
    if (parts.empty() || (parts.size() == 1 && parts[0].text.size() >= text.size())) continue;
    Reading reading = agreed(parts, depth);
    if (reading.verdict == Verdict::kRead && !is_free &&
        is_doubtful_around(text, parts, place, reading))
      reading = {.verdict = Verdict::kUnclear, .rule = std::move(reading.rule)};
    reading.rule = std::string(place.info.name) + ": " + reading.rule;
    return reading;
  }
  return by_rules(text);
}

// The sentence of each mark before its part, all that follows the last part, and what that would be
// read as on its own.
bool AnswerReader::is_doubtful_around(std::string_view text, const std::vector<FoundPart>& parts,
                                      const Place& place, const Reading& reading) const {
  constexpr std::size_t kMost = 50;  // parts; beyond it nobody answers
  if (parts.size() > kMost) return true;
  const Tokens tokens = tokens_of(text);
  const std::vector<Named> named = names_.find(tokens);
  std::size_t last_end = 0;
  for (const FoundPart& part : parts) {
    if (is_denied_before(context_, {text, tokens, named}, part, place, reading)) return true;
    last_end = std::max(last_end, part.end);
  }
  if (is_denied_behind(context_, {text, tokens, named}, last_end, reading)) return true;
  const std::string_view rest = trimmed(text.substr(last_end));
  if (rest.empty()) return false;
  const Reading other = by_rules(rest);
  if (other.verdict != Verdict::kRead || other.rule == "pair") return false;
  return other.option != reading.option || other.yes != reading.yes ||
         other.number != reading.number || other.point != reading.point;
}

// Blank parts say nothing.
Reading AnswerReader::agreed(const std::vector<FoundPart>& parts, int depth) const {
  std::optional<Reading> first;
  std::string first_rule;
  for (const FoundPart& part : parts) {
    Reading reading = read_part(part.text, depth + 1);
    if (reading.verdict == Verdict::kEmpty) continue;
    std::string rule = std::exchange(reading.rule, {});
    if (!first) {
      first = reading;
      first_rule = std::move(rule);
    } else if (reading != *first) {
      return {.verdict = Verdict::kUnclear, .rule = "two answers"};
    }
  }
  if (!first) return {.verdict = Verdict::kEmpty, .rule = "blank"};
  first->rule = std::move(first_rule);
  return *first;
}

Reading AnswerReader::by_rules(std::string_view text) const {
  const Tokens tokens = tokens_of(text);
  const std::vector<Named> named = names_.find(tokens);
  for (const ReadRule& rule : rules_of(context_.form)) {
    const AnswerPart part{text, tokens, named};
    std::optional<Reading> reading = rule.read(context_, part);
    if (!reading) continue;
    if (reading->verdict == Verdict::kRead && is_doubtful(context_, part, rule, *reading))
      reading = unclear();
    reading->rule = rule.name;
    return *reading;
  }
  return {.verdict = Verdict::kUnclear, .rule = "nothing that answers"};
}

Reading AnswerReader::read(std::string_view raw, std::string_view finish) const {
  const std::string said = without_thoughts(raw);
  const std::string_view answer = trimmed(said);
  if (answer.size() > kLongestAnswer) return {.verdict = Verdict::kUnclear, .rule = "too long"};
  const std::string text = plain_form(without_colours(answer));
  if (trimmed(text).empty())
    return {.verdict = Verdict::kEmpty,
            .rule = said.size() == raw.size() ? "blank" : "thoughts alone"};
  // "1\u00b2" would be 12 without its superscript.
  if (context_.form == plan::QuestionForm::kNumber && has_superscript(answer))
    return {.verdict = Verdict::kUnclear, .rule = "hedged"};
  // Compatible characters may be written out at length.
  if (text.size() > 4 * kLongestAnswer) return {.verdict = Verdict::kUnclear, .rule = "too long"};
  if (is_cut(finish) && !has_whole_place(context_, text))
    return {.verdict = Verdict::kUnclear, .rule = std::string(kCutRule)};
  return read_part(text, 0);
}

Reading read_answer(const ReadContext& context, std::string_view raw, std::string_view finish) {
  return AnswerReader(context).read(raw, finish);
}

std::string free_part(std::string_view raw) {
  std::string text = plain_form(without_colours(trimmed(without_thoughts(raw))));
  const ReadContext context{.form = plan::QuestionForm::kFree};
  const std::span<const Place> places = answer_places();
  for (std::size_t depth = 0, place = 0; depth < kDeepest && place < places.size();) {
    if (!places[place].says_its_end) break;
    std::vector<FoundPart> parts = places[place].find(context, text);
    std::erase_if(parts, [](const FoundPart& part) { return trimmed(part.text).empty(); });
    if (parts.empty() || parts[0].text.size() >= text.size()) {
      ++place;
      continue;
    }
    text = std::move(parts[0].text);
    place = 0;
    ++depth;
  }
  return text;
}

std::vector<RuleInfo> places() {
  std::vector<RuleInfo> out;
  for (const Place& place : answer_places()) out.push_back(place.info);
  return out;
}

std::vector<RuleInfo> rules(plan::QuestionForm form) {
  std::vector<RuleInfo> out;
  for (const ReadRule& rule : rules_of(form)) out.push_back({rule.name, rule.says});
  return out;
}

}  // namespace probe::ask
