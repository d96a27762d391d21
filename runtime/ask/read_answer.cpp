#include "runtime/ask/read_answer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "runtime/ask/read_doubt.h"
#include "runtime/ask/read_rules.h"
#include "runtime/base/json.h"
#include "runtime/base/utf8.h"

namespace probe::ask {
namespace {

using Texts = std::vector<std::string>;

bool is_gap(char c) { return c == ' ' || c == '\n' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_gap(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_gap(text.back())) text.remove_suffix(1);
  return text;
}

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

// ---- places ---------------------------------------------------------------------------------

// Between each `open` and the next of `closes`, or the end of the text.
void add_between(std::string_view text, std::string_view low, std::string_view open,
                 std::string_view close, Texts& out) {
  for (std::size_t at = low.find(open); at != low.npos; at = low.find(open, at)) {
    at += open.size();
    const std::size_t end = std::min(low.find(close, at), low.size());
    out.push_back(std::string(text.substr(at, end - at)));
    at = end;
  }
}

Texts find_tags(const ReadContext&, std::string_view text) {
  const std::string low = lowered(text);
  Texts out;
  for (const char* name : {"answer", "final_answer", "ans"}) {
    add_between(text, low, std::string("<") + name + ">", std::string("</") + name + ">", out);
  }
  return out;
}

// \boxed{..}, with braces inside, and <|begin_of_box|>..<|end_of_box|>.
Texts find_boxes(const ReadContext&, std::string_view text) {
  constexpr std::string_view kBox = "\\boxed{";
  Texts out;
  for (std::size_t at = text.find(kBox); at != text.npos; at = text.find(kBox, at)) {
    at += kBox.size();
    std::size_t end = at;
    for (int depth = 1; end < text.size(); ++end) {
      if (text[end] == '{') ++depth;
      if (text[end] == '}' && --depth == 0) break;
    }
    out.push_back(std::string(text.substr(at, end - at)));
    at = end;
  }
  add_between(text, text, "<|begin_of_box|>", "<|end_of_box|>", out);
  return out;
}

constexpr auto kAnswerKeys =
    std::to_array<std::string_view>({"answer", "final_answer", "option", "choice", "letter",
                                     "label", "count", "number", "result", "object"});

// A value as the rules of its form read it.
std::string as_text(const Json& value) {
  if (value.is_string()) return value.text();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_array() && value.size() == 1) return as_text(value[0]);
  return value.dump();
}

// The object or array that a text is, or that stands in it between the first and the last bracket
// of its kind (in a fence of code, behind words).
std::optional<Json> json_in(std::string_view text) {
  const std::size_t begin = text.find_first_of("{[");
  if (begin == text.npos) return std::nullopt;
  const std::size_t end = text.find_last_of(text[begin] == '{' ? '}' : ']');
  if (end == text.npos || end < begin) return std::nullopt;
  Json json = Json::parse(text.substr(begin, end + 1 - begin));
  if (json.is_discarded()) return std::nullopt;
  return json;
}

Texts find_json(const ReadContext& context, std::string_view text) {
  // A point's keys and brackets are its own rules' work.
  if (context.form == plan::QuestionForm::kPoint) return {};
  std::optional<Json> json = json_in(text);
  if (!json) return {};
  while (json->is_array() && json->size() == 1 && json->front().is_object())
    json = Json(json->front());
  if (!json->is_object()) return {};
  Texts out;
  for (const auto& [key, value] : json->items()) {
    const std::string low = lowered(key);
    if (std::find(kAnswerKeys.begin(), kAnswerKeys.end(), low) == kAnswerKeys.end()) continue;
    out.push_back(as_text(value));
  }
  return out;
}

constexpr auto kAnswerNouns = std::to_array<std::string_view>(
    {"answer", "choice", "option", "letter", "response", "solution", "count"});
constexpr auto kIs = std::to_array<std::string_view>(
    {"is", "would be", "should be", "must be", "will be", "has to be"});

// Where what is said begins behind "the answer is" or "answer:", a token's index; 0: it is none.
std::size_t behind_marker(const Tokens& tokens, std::size_t at) {
  const bool noun = tokens[at].is_word() && std::find(kAnswerNouns.begin(), kAnswerNouns.end(),
                                                      tokens[at].text) != kAnswerNouns.end();
  // "B is the right answer: ..." has answered before.
  for (std::size_t back = at; noun && back > 0 && at - back < 4;) {
    const Token& before = tokens[--back];
    if (!before.is_word()) break;
    if (before.is("is") || before.is("as")) return 0;
    // "The wrong answer is A" says which one it is not.
    if (before.is("wrong") || before.is("incorrect") || before.is("not")) return 0;
  }
  if (!noun) return 0;
  ++at;
  const auto is_colon = [&] {
    return at < tokens.size() && (tokens[at].is_sign(':') || tokens[at].is_sign('='));
  };
  if (is_colon()) return at + 1;
  for (const std::string_view is : kIs) {
    if (!stands_phrase(tokens, at, is)) continue;
    at += 1 + static_cast<std::size_t>(std::count(is.begin(), is.end(), ' '));
    return is_colon() ? at + 1 : at;
  }
  return 0;
}

// What follows on the line, or where nothing does, the next line that is not empty.
Texts find_answer_lines(const ReadContext&, std::string_view text) {
  const Tokens tokens = tokens_of(text);
  Texts out;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const std::size_t begin = behind_marker(tokens, at);
    if (begin == 0) continue;
    std::size_t first = begin;
    while (first < tokens.size() && tokens[first].kind == TokenKind::kBreak) ++first;
    if (first == tokens.size()) continue;
    std::size_t end = first;
    while (end < tokens.size() && tokens[end].kind != TokenKind::kBreak) ++end;
    // From the end of the token before, so that a sign of a number stays.
    const std::size_t from = tokens[first].begin, to = tokens[end - 1].end;
    out.push_back(std::string(text.substr(from, to - from)));
    at = end - 1;
  }
  return out;
}

struct Place {
  RuleInfo info;
  Texts (*find)(const ReadContext& context, std::string_view text);
};
constexpr Place kPlaces[] = {
    {{"tag", "between <answer> and </answer>, or from it to the end"}, find_tags},
    {{"box", "in \\boxed{}, or between marks of a box"}, find_boxes},
    {{"json", "a value of JSON whose key is answer, option, count or the like"}, find_json},
    {{"answer line", "behind \"answer:\" or \"the answer is\", to the end of the line"},
     find_answer_lines},
};

// ---- rules ----------------------------------------------------------------------------------

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
  constexpr auto kDenials = std::to_array<std::string_view>(
      {"not",       "no",        "never",  "isnt",     "arent",  "dont",    "doesnt",
       "wasnt",     "shouldnt",  "cant",   "cannot",   "wont",   "except",  "without",
       "nor",       "neither",   "avoid",  "avoiding", "rather", "instead", "unlike",
       "wrong",     "incorrect", "mustnt", "wouldnt",  "ignore", "rule",    "exclude",
       "excluding", "ignoring",  "skip",   "skipping"});
  constexpr std::size_t kFar = 30;  // tokens
  const std::size_t last = at > kFar ? at - kFar : 0;
  while (at > last) {
    const Token& token = tokens[--at];
    if (token.is_end() || token.is_sign(';') || token.is_sign(':') || token.is("but")) return false;
    // "The others are wrong, so it is B" concludes.
    if (token.is("so") && at > 0 && tokens[at - 1].is_sign(',')) return false;
    if (std::find(kDenials.begin(), kDenials.end(), token.text) != kDenials.end()) return true;
  }
  return false;
}

namespace {

bool has_superscript(std::string_view text) {
  constexpr auto kSigns =
      std::to_array<std::string_view>({"\u00b2", "\u00b3", "\u00b9", "\u2070", "\u2074", "\u2075",
                                       "\u2076", "\u2077", "\u2078", "\u2079"});
  return std::any_of(kSigns.begin(), kSigns.end(),
                     [&](std::string_view sign) { return text.find(sign) != text.npos; });
}

}  // namespace

AnswerReader::AnswerReader(ReadContext context)
    : context_(std::move(context)), names_(context_.options, context_.question) {}

Reading AnswerReader::read_part(std::string_view text, int depth) const {
  text = trimmed(text);
  if (text.empty()) return {.verdict = Verdict::kEmpty, .rule = "blank"};
  // A sentence is read as it stands.
  const bool is_free = context_.form == plan::QuestionForm::kFree;
  for (const Place& place : kPlaces) {
    if (depth == kDeepest || (is_free && place.find == find_answer_lines)) break;
    const Texts parts = place.find(context_, text);
    // A part that is the text itself would be found again.
    if (parts.empty() || (parts.size() == 1 && parts[0].size() >= text.size())) continue;
    Reading reading = agreed(parts, depth);
    reading.rule = std::string(place.info.name) + ": " + reading.rule;
    return reading;
  }
  return by_rules(text);
}

// Blank parts say nothing.
Reading AnswerReader::agreed(const Texts& parts, int depth) const {
  std::optional<Reading> first;
  std::string first_rule;
  for (const std::string& part : parts) {
    Reading reading = read_part(part, depth + 1);
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

Reading AnswerReader::read(std::string_view raw) const {
  const std::string said = without_thoughts(raw);
  const std::string_view answer = trimmed(said);
  if (answer.size() > kLongestAnswer) return {.verdict = Verdict::kUnclear, .rule = "too long"};
  const std::string text = plain_form(answer);
  if (trimmed(text).empty())
    return {.verdict = Verdict::kEmpty,
            .rule = said.size() == raw.size() ? "blank" : "thoughts alone"};
  // "1\u00b2" would be 12 without its superscript.
  if (context_.form == plan::QuestionForm::kNumber && has_superscript(answer))
    return {.verdict = Verdict::kUnclear, .rule = "hedged"};
  // Compatible characters may be written out at length.
  if (text.size() > 4 * kLongestAnswer) return {.verdict = Verdict::kUnclear, .rule = "too long"};
  return read_part(text, 0);
}

Reading read_answer(const ReadContext& context, std::string_view raw) {
  return AnswerReader(context).read(raw);
}

std::string free_part(std::string_view raw) {
  std::string text = plain_form(trimmed(without_thoughts(raw)));
  const ReadContext context{.form = plan::QuestionForm::kFree};
  for (std::size_t depth = 0, place = 0; depth < kDeepest && place < std::size(kPlaces);) {
    if (kPlaces[place].find == find_answer_lines) break;
    Texts parts = kPlaces[place].find(context, text);
    std::erase_if(parts, [](const std::string& part) { return trimmed(part).empty(); });
    if (parts.empty() || parts[0].size() >= text.size()) {
      ++place;
      continue;
    }
    text = std::move(parts[0]);
    place = 0;
    ++depth;
  }
  return text;
}

std::vector<RuleInfo> places() {
  std::vector<RuleInfo> out;
  for (const Place& place : kPlaces) out.push_back(place.info);
  return out;
}

std::vector<RuleInfo> rules(plan::QuestionForm form) {
  std::vector<RuleInfo> out;
  for (const ReadRule& rule : rules_of(form)) out.push_back({rule.name, rule.says});
  return out;
}

}  // namespace probe::ask
