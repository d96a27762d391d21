#include "runtime/ask/reading/read_places.h"

#include <algorithm>
#include <array>

#include "runtime/base/json.h"

namespace probe::ask {
namespace {

using Parts = std::vector<FoundPart>;

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

// Between each `open` and the next of `closes`, or the end of the text.
void add_between(std::string_view text, std::string_view low, std::string_view open,
                 std::string_view close, Parts& out) {
  for (std::size_t at = low.find(open); at != low.npos; at = low.find(open, at)) {
    const std::size_t begin = at;
    at += open.size();
    const std::size_t found = low.find(close, at);
    const std::size_t end = std::min(found, low.size());
    const std::size_t behind = found == low.npos ? end : end + close.size();
    out.push_back({std::string(text.substr(at, end - at)), begin, behind, found != low.npos});
    at = end;
  }
}

Parts find_tags(const ReadContext&, std::string_view text) {
  const std::string low = lowered(text);
  Parts out;
  for (const char* name : {"answer", "final_answer", "ans"}) {
    add_between(text, low, std::string("<") + name + ">", std::string("</") + name + ">", out);
  }
  return out;
}

// \boxed{..}, with braces inside, and <|begin_of_box|>..<|end_of_box|>.
Parts find_boxes(const ReadContext&, std::string_view text) {
  constexpr std::string_view kBox = "\\boxed{";
  Parts out;
  for (std::size_t at = text.find(kBox); at != text.npos; at = text.find(kBox, at)) {
    const std::size_t begin = at;
    at += kBox.size();
    std::size_t end = at;
    for (int depth = 1; end < text.size(); ++end) {
      if (text[end] == '{') ++depth;
      if (text[end] == '}' && --depth == 0) break;
    }
    const bool closed = end < text.size();
    out.push_back({std::string(text.substr(at, end - at)), begin, closed ? end + 1 : end, closed});
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

// Where the bracket at `at` is closed, strings aside; npos: nowhere.
std::size_t closing_bracket(std::string_view text, std::size_t at) {
  int depth = 0;
  bool quoted = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quoted) {
      if (c == '\\') ++at;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if ((c == '}' || c == ']') && --depth == 0) {
      return at;
    }
  }
  return text.npos;
}

void add_values(const Json& json, std::size_t begin, std::size_t end, Parts& out) {
  if (json.is_array()) {
    for (const Json& one : json) {
      if (one.is_object()) add_values(one, begin, end, out);
    }
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    const std::string low = lowered(key);
    if (std::find(kAnswerKeys.begin(), kAnswerKeys.end(), low) == kAnswerKeys.end()) continue;
    out.push_back({as_text(value), begin, end});
  }
}

// Of every object, or array of objects, in the text (in a fence of code, behind words).
Parts find_json(const ReadContext& context, std::string_view text) {
  // A point's keys and brackets are its own rules' work.
  if (context.form == plan::QuestionForm::kPoint) return {};
  Parts out;
  for (std::size_t at = text.find_first_of("{["); at != text.npos;
       at = text.find_first_of("{[", at)) {
    const std::size_t end = closing_bracket(text, at);
    if (end == text.npos) break;
    const Json json = Json::parse(text.substr(at, end + 1 - at));
    if (!json.is_discarded()) add_values(json, at, end + 1, out);
    at = end + 1;
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
Parts find_answer_lines(const ReadContext&, std::string_view text) {
  const Tokens tokens = tokens_of(text);
  Parts out;
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
    out.push_back({std::string(text.substr(from, to - from)), tokens[at].begin, to, false});
    at = end - 1;
  }
  return out;
}

constexpr Place kPlaces[] = {
    {{"tag", "between <answer> and </answer>, or from it to the end"}, true, find_tags},
    {{"box", "in \\boxed{}, or between marks of a box"}, true, find_boxes},
    {{"json", "a value of JSON whose key is answer, option, count or the like"}, true, find_json},
    {{"answer line", "behind \"answer:\" or \"the answer is\", to the end of the line"},
     false,
     find_answer_lines},
};

}  // namespace

std::span<const Place> answer_places() { return kPlaces; }

}  // namespace probe::ask
