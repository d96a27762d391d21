// How a whole number is read.
#include <algorithm>
#include <array>
#include <charconv>

#include "runtime/ask/reading/read_letters.h"

namespace probe::ask {
namespace {

constexpr auto kNumberWords = std::to_array<std::string_view>(
    {"zero",     "one",     "two",     "three",     "four",     "five",     "six",
     "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",   "thirteen",
     "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty"});

// Words that make a number a bound or a guess of another one, or no count.
constexpr auto kHedges = std::to_array<std::string_view>(
    {"least",   "most",       "more",          "less",     "fewer",   "over",   "under",
     "about",   "around",     "approximately", "roughly",  "nearly",  "almost", "several",
     "maybe",   "hundred",    "thousand",      "million",  "dozen",   "half",   "minus",
     "point",   "approx",     "circa",         "ca",       "ish",     "max",    "min",
     "maximum", "minimum",    "upwards",       "above",    "below",   "beyond", "up",
     "close",   "somewhere",  "near",          "negative", "percent", "times",  "twice",
     "dozens",  "thereabouts"});

struct NumberAt {
  std::size_t token = 0;
  std::optional<std::int64_t> value;  // none: negative, with a fraction, a percentage, too large
};

bool is_touching(const Token& left, const Token& right) { return left.end == right.begin; }

// A minus sign, a decimal comma or a slash before it, a per cent behind it make it no count.
std::optional<std::int64_t> whole(const Tokens& tokens, std::size_t at) {
  const Token& token = tokens[at];
  if (at > 0 && is_touching(tokens[at - 1], token)) {
    const Token& before = tokens[at - 1];
    const bool is_range =
        at > 1 && is_touching(tokens[at - 2], before) && tokens[at - 2].kind == TokenKind::kNumber;
    if (before.is_sign('-') || before.is_sign('/') || before.is_sign('<') || before.is_sign('>'))
      return std::nullopt;
    if (is_range) return std::nullopt;
  }
  if (at + 1 < tokens.size() && tokens[at + 1].is_sign('%')) return std::nullopt;
  std::int64_t value = 0;
  const char* end = token.text.data() + token.text.size();
  const auto read = std::from_chars(token.text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return value;
}

std::vector<NumberAt> numbers_of(const Tokens& tokens) {
  std::vector<NumberAt> found;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (tokens[at].kind == TokenKind::kNumber) {
      found.push_back({at, whole(tokens, at)});
      continue;
    }
    const auto word = std::find(kNumberWords.begin(), kNumberWords.end(), tokens[at].text);
    if (word != kNumberWords.end()) found.push_back({at, word - kNumberWords.begin()});
  }
  return found;
}

Reading counted(std::optional<std::int64_t> value) {
  if (!value) return unclear();
  return {.verdict = Verdict::kRead, .number = value};
}

// Signs that leave a number what it is; others make it a bound, a guess or a sum.
bool is_harmless_sign(const Token& token) {
  constexpr auto kHarmless = std::to_array<std::string_view>(
      {".", ",", ":", ";", "!", "(", ")", "[", "]", "=", "\u2705", "\u2713", "\u2714", "\u2611"});
  return token.kind != TokenKind::kSign ||
         std::find(kHarmless.begin(), kHarmless.end(), token.text) != kHarmless.end();
}

// Signs or words of a sentence [from, end) that qualify its numbers.
bool is_qualifying(const ReadContext& context, const Tokens& tokens, std::size_t from,
                   std::size_t end) {
  constexpr auto kCounting = std::to_array<std::string_view>(
      {"there", "see",  "count", "counted", "counts", "total",     "altogether", "number",
       "all",   "them", "thing", "things",  "kind",   "different", "visible",    "present",
       "left",  "you",  "we",    "where",   "and",    "such",      "each",       "side"});
  const auto known = known_words(context);
  // "approx. 3"
  if (from > 1 && tokens[from - 1].is_sign('.') &&
      std::find(kHedges.begin(), kHedges.end(), tokens[from - 2].text) != kHedges.end())
    return true;
  for (std::size_t i = from; i < end; ++i) {
    const Token& token = tokens[i];
    if (!is_harmless_sign(token)) return true;
    if (!token.is_word()) continue;
    // "2 x 2"
    if (token.text.size() == 1 && !token.is("a") && !token.is("i") && !token.is("s")) return true;
    const bool counts =
        std::find(kCounting.begin(), kCounting.end(), token.text) != kCounting.end() ||
        std::find(kNumberWords.begin(), kNumberWords.end(), token.text) != kNumberWords.end();
    if (!counts && !is_known_word(known, token)) return true;
  }
  return false;
}

// "Picture 3", and "1. carrot", which counts the lines of a list.
bool is_numbering(const Tokens& tokens, std::size_t at) {
  constexpr auto kNumbered =
      std::to_array<std::string_view>({"picture", "image", "photo", "scene", "object", "item",
                                       "option", "label", "question", "task", "robot"});
  if (at > 0 &&
      std::find(kNumbered.begin(), kNumbered.end(), tokens[at - 1].text) != kNumbered.end())
    return true;
  const bool begins = at == 0 || tokens[at - 1].kind == TokenKind::kBreak;
  return begins && tokens[at].text == "1" && at + 2 < tokens.size() &&
         (tokens[at + 1].is_sign('.') || tokens[at + 1].is_sign(')')) && tokens[at + 2].is_word();
}

// Every number of a range, if they agree.
Reading agreed_number(const std::vector<NumberAt>& numbers) {
  for (const NumberAt& number : numbers) {
    if (!number.value || *number.value != numbers[0].value) return unclear();
  }
  return counted(numbers[0].value);
}

// Words that stand in a range beside numbers and articles.
bool has_other_words(const Tokens& tokens, std::size_t first, std::size_t end) {
  for (std::size_t at = first; at < end; ++at) {
    if (!tokens[at].is_word()) continue;
    const auto word = std::find(kNumberWords.begin(), kNumberWords.end(), tokens[at].text);
    if (word == kNumberWords.end()) return true;
  }
  return false;
}

// "2 2" is no count, "two (2)" is.
bool tokens_are_digits(const Tokens& tokens, const std::vector<NumberAt>& numbers) {
  return std::ranges::all_of(numbers, [&](const NumberAt& number) {
    return tokens[number.token].kind == TokenKind::kNumber;
  });
}

// The first or last sentence holds numbers alone; what else is counted elsewhere is an explanation.
std::optional<Reading> number_alone(const ReadContext& context, const AnswerPart& part) {
  const auto numbers = numbers_of(part.tokens);
  const auto sentences = sentences_of(part.tokens);
  std::optional<Reading> first;
  for (const auto& [begin, end] : sentences) {
    if (has_other_words(part.tokens, begin, end)) continue;
    std::vector<NumberAt> here;
    const auto from =
        std::lower_bound(numbers.begin(), numbers.end(), begin,
                         [](const NumberAt& number, std::size_t t) { return number.token < t; });
    for (auto at = from; at != numbers.end() && at->token < end; ++at) here.push_back(*at);
    if (here.empty()) continue;
    Reading reading = agreed_number(here);
    const bool twice = here.size() > 1 && tokens_are_digits(part.tokens, here);
    if (twice || is_qualifying(context, part.tokens, begin, end) ||
        is_numbering(part.tokens, here[0].token))
      reading = unclear();
    if (first && reading != *first) return unclear();
    first = reading;
    const bool at_an_end = begin == sentences.front().first || begin == sentences.back().first;
    if (!at_an_end) return std::nullopt;
  }
  return first;
}

std::optional<Reading> refused_number(const ReadContext&, const AnswerPart& part) {
  if (!is_refusal(part.tokens)) return std::nullopt;
  return Reading{.verdict = Verdict::kRefused};
}

std::optional<Reading> hedged(const ReadContext&, const AnswerPart& part) {
  for (const Token& token : part.tokens) {
    if (std::find(kHedges.begin(), kHedges.end(), token.text) != kHedges.end()) return unclear();
  }
  return std::nullopt;
}

std::optional<Reading> one_number(const ReadContext& context, const AnswerPart& part) {
  const auto numbers = numbers_of(part.tokens);
  if (numbers.empty()) return std::nullopt;
  constexpr std::size_t kMost = 100;  // nobody counts so often
  if (numbers.size() > kMost) return unclear();
  for (const auto& [begin, end] : sentences_of(part.tokens)) {
    const auto inside = [&, from = begin, to = end](const NumberAt& number) {
      return number.token >= from && number.token < to;
    };
    if (std::ranges::any_of(numbers, inside) && is_qualifying(context, part.tokens, begin, end))
      return unclear();
  }
  for (const NumberAt& number : numbers) {
    if (is_denied(part.tokens, number.token)) return unclear();
    if (is_numbering(part.tokens, number.token)) return unclear();
  }
  return agreed_number(numbers);
}

std::optional<Reading> none_at_all(const ReadContext&, const AnswerPart& part) {
  constexpr auto kNone = std::to_array<std::string_view>(
      {"none", "there are no", "there is no", "there arent any", "there are not any"});
  if (!has_phrase(part.tokens, kNone)) return std::nullopt;
  return counted(0);
}

constexpr ReadRule kNumberRules[] = {
    {"number alone", "digits, or zero to twenty, alone in the first or last sentence",
     number_alone},
    {"refused", "words that say that it cannot or will not answer", refused_number},
    {"hedged", "at least, about, a dozen: unclear", hedged},
    {"one number", "the one number in it; 3 or 4, -3 and 2.5 are unclear", one_number},
    {"none", "none, there are no", none_at_all},
};

}  // namespace

std::span<const ReadRule> number_rules() { return kNumberRules; }

}  // namespace probe::ask
