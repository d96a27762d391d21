#include "runtime/ask/read_doubt.h"

#include <algorithm>
#include <array>

namespace probe::ask {
namespace {

using Words = std::span<const std::string_view>;

bool one_of(Words words, const Token& token) {
  return token.is_word() && std::find(words.begin(), words.end(), token.text) != words.end();
}

bool has_any(const Tokens& tokens, Words words) {
  return std::any_of(tokens.begin(), tokens.end(),
                     [&](const Token& token) { return one_of(words, token); });
}

constexpr auto kDenying = std::to_array<std::string_view>(
    {"not", "no", "never", "isnt", "arent", "wasnt", "doesnt", "dont", "cant", "cannot", "shouldnt",
     "mustnt", "wont", "neither", "hardly"});

bool is_denying(const Token& token) { return one_of(kDenying, token); }

// ---- choices ----------------------------------------------------------------------------------

// Words that say which one it is not, wherever they stand.
constexpr auto kRejecting = std::to_array<std::string_view>(
    {"incorrect", "wrong",      "false",   "eliminate", "eliminated", "eliminating", "exclude",
     "excluded",  "opposite",   "least",   "unlikely",  "besides",    "except",      "alone",
     "ruled",     "untouched",  "avoid",   "avoided",   "reject",     "rejected",    "wait",
     "actually",  "correction", "scratch", "none",      "neither"});
constexpr auto kOtherThan = std::to_array<std::string_view>(
    {"other than", "anything but", "all but", "everything but", "rather than"});
constexpr auto kMore = std::to_array<std::string_view>({"or", "and", "then"});
constexpr auto kVerdicts = std::to_array<std::string_view>({"yes", "no", "true", "false"});
constexpr auto kAreVerbs = std::to_array<std::string_view>(
    {"is",       "are",  "was",    "isnt", "arent", "wasnt",   "should",
     "shouldnt", "must", "mustnt", "can",  "cant",  "cannot",  "does",
     "doesnt",   "has",  "will",   "wont", "would", "wouldnt", "could"});

// "the others are wrong", "none of the other options is round": a clause that speaks of those that
// were not chosen, and so denies nothing of the one that was. Its tokens' range is [at, end); its
// end is at, where it is none.
std::size_t end_of_others(const ReadContext& context, const AnswerPart& part, std::size_t at) {
  constexpr auto kLeading = std::to_array<std::string_view>(
      {"all", "none", "neither", "of", "and", "but", "while", "because", "as", "since", "the"});
  const Tokens& tokens = part.tokens;
  std::size_t from = at;
  while (from < tokens.size() && one_of(kLeading, tokens[from])) ++from;
  constexpr auto kOthers = std::to_array<std::string_view>({"others", "other", "rest"});
  if (from == tokens.size() || !one_of(kOthers, tokens[from])) return at;
  std::size_t end = from;
  const auto is_break = [](const Token& token) {
    return token.is_end() || token.is_sign(';') || token.is_sign(',');
  };
  while (end < tokens.size() && !is_break(tokens[end])) ++end;
  // Who names an option speaks of that one, too.
  for (std::size_t i = from; i < end; ++i) {
    const bool is_letter =
        context.letters && tokens[i].capital && tokens[i].is_word() && tokens[i].text.size() == 1;
    if (is_letter) return at;
  }
  const auto is_inside = [&](const Named& name) { return name.begin >= from && name.begin < end; };
  return std::any_of(part.named.begin(), part.named.end(), is_inside) ? at : end;
}

// All but such clauses.
Tokens about_the_chosen(const ReadContext& context, const AnswerPart& part) {
  Tokens left;
  bool begins = true;  // a clause
  for (std::size_t at = 0; at < part.tokens.size();) {
    const Token& token = part.tokens[at];
    begins = begins || token.is("because") || token.is("and") || token.is("while");
    const std::size_t end = begins ? end_of_others(context, part, at) : at;
    begins = end > at || !token.is_word();
    if (end == at) left.push_back(token);
    at = std::max(end, at + 1);
  }
  return left;
}

// "B is closest", which hedges; "closest to the gripper" describes.
bool is_nearly(const Tokens& tokens) {
  constexpr auto kNearly = std::to_array<std::string_view>({"close", "closest", "nearest"});
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const bool describes = at + 1 < tokens.size() && tokens[at + 1].is_word();
    if (one_of(kNearly, tokens[at]) && !describes) return true;
  }
  return false;
}

// The first word behind `at`, before its sentence ends; a sign of a letter ("B.") ends it, too.
std::size_t word_behind(const Tokens& tokens, std::size_t at) {
  while (at < tokens.size() && tokens[at].kind == TokenKind::kSign && !tokens[at].is_end()) ++at;
  return at;
}

// "B is not the one", "The carrot isn't": a verb right behind what ends at `end`, and a denial.
bool is_denied_behind(const Tokens& tokens, std::size_t end) {
  constexpr std::size_t kFar = 4;  // tokens
  const std::size_t verb = word_behind(tokens, end);
  if (verb >= tokens.size()) return false;
  if (is_denying(tokens[verb])) return true;
  if (!one_of(kAreVerbs, tokens[verb])) return false;
  for (std::size_t at = verb; at < tokens.size() && at < verb + kFar; ++at) {
    if (tokens[at].kind != TokenKind::kWord) return false;
    if (is_denying(tokens[at]) || tokens[at].is("wouldnt")) return true;
  }
  return false;
}

bool is_letter_of(const ReadContext& context, const Token& token) {
  return token.is_word() && token.text.size() == 1 && token.text[0] >= 'a' &&
         static_cast<std::size_t>(token.text[0] - 'a') < context.options.size();
}

// "A: no", "A is", "B or": what stands behind a letter.
bool is_letter_doubtful(const ReadContext& context, const Tokens& tokens, const Reading& reading) {
  bool is_chosen = false, is_other = false;  // the subject of "is"
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (!is_letter_of(context, tokens[at])) continue;
    const auto place = static_cast<std::size_t>(tokens[at].text[0] - 'a');
    const bool chosen = context.options[place].option == reading.option;
    const std::size_t next = word_behind(tokens, at + 1);
    if (at > 0 && tokens[at - 1].is_sign('!') && tokens[at - 1].end == tokens[at].begin)
      return true;
    if (next >= tokens.size()) continue;
    if (one_of(kVerdicts, tokens[next])) return true;
    if (chosen && (is_denied_behind(tokens, at + 1) || one_of(kMore, tokens[next]))) return true;
    if (tokens[next].is("is")) (chosen ? is_chosen : is_other) = true;
  }
  return is_chosen && is_other;
}

bool is_choice_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                        const Reading& reading) {
  const Tokens& tokens = part.tokens;
  const Tokens chosen = about_the_chosen(context, part);
  if (has_any(chosen, kRejecting) || has_phrase(chosen, kOtherThan) || is_nearly(tokens))
    return true;
  if (part.text.find("~~") != part.text.npos) return true;
  // Who asks has not answered.
  const auto asks = [](const Token& token) { return token.is_sign('?'); };
  if (std::any_of(tokens.begin(), tokens.end(), asks)) return true;
  for (const auto& [first, end] : sentences_of(tokens)) {
    // "B. No other object is orange." explains, "No, the carrot" takes back.
    const bool alone = first + 1 == end || !tokens[first + 1].is_word();
    if (tokens[first].is("no") && alone) return true;
  }
  if (rule.name.starts_with("letter")) return is_letter_doubtful(context, tokens, reading);
  for (const Token& token : tokens) {
    if (token.is("or")) return true;
  }
  for (const Named& name : part.named) {
    if (context.options[name.place].option != reading.option) continue;
    if (is_denied_behind(tokens, name.end) || is_denied(tokens, name.begin)) return true;
  }
  return false;
}

// ---- yes and no -------------------------------------------------------------------------------

constexpr auto kUnsure = std::to_array<std::string_view>(
    {"maybe", "perhaps", "possibly", "if", "unless", "might", "wait", "actually"});
constexpr auto kSides = std::to_array<std::string_view>(
    {"left", "right", "above", "below", "front", "behind", "under", "over", "near", "far"});
// What may follow a "no" that answers.
constexpr auto kBehindNo =
    std::to_array<std::string_view>({"it", "its", "there", "the", "they", "this", "that", "i",
                                     "because", "since", "as", "not", "a", "an", "sorry"});

bool has_word_of(const std::vector<std::string>& asked, const Token& token) {
  return std::any_of(asked.begin(), asked.end(),
                     [&](const std::string& word) { return is_same_noun(word, token.text); });
}

// "No doubt", "No objects block": a "no" that denies its noun, not what was asked.
bool is_about_noun(const Tokens& tokens, const std::vector<std::string>& asked, bool presence) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (!tokens[at].is("no") || !tokens[at + 1].is_word()) continue;
    const bool begins = at == 0 || !tokens[at - 1].is_word();
    if (!begins || one_of(kBehindNo, tokens[at + 1])) continue;
    if (!presence || !has_word_of(asked, tokens[at + 1])) return true;
  }
  return false;
}

bool is_yesno_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                       const Reading& reading) {
  const Tokens& tokens = part.tokens;
  if (has_any(tokens, kUnsure)) return true;
  const std::vector<std::string> asked = plain_words(context.question);
  const bool presence = asks_for_presence(context);
  if (rule.name == "there is") return !presence;
  if (is_about_noun(tokens, asked, presence)) return true;
  const bool yes = reading.yes.value_or(false);
  if (yes && has_any(tokens, kDenying)) return true;
  const bool has_side = std::any_of(asked.begin(), asked.end(), [](const std::string& word) {
    return std::find(kSides.begin(), kSides.end(), word) != kSides.end();
  });
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (!yes && tokens[at].is("yes")) return true;
    if (!has_side || !one_of(kSides, tokens[at])) continue;
    const bool same = std::find(asked.begin(), asked.end(), tokens[at].text) != asked.end();
    if (yes && !same) return true;
    // The "no" that answers denies nothing behind its sign.
    std::size_t from = at;
    constexpr std::size_t kFar = 30;  // tokens
    while (from > 0 && at - from < kFar && !tokens[from - 1].is_end() &&
           !tokens[from - 1].is_sign(','))
      --from;
    const auto clause = std::span(tokens).subspan(from, at - from);
    if (!yes && same && std::none_of(clause.begin(), clause.end(), is_denying)) return true;
  }
  return false;
}

// ---- numbers and points -----------------------------------------------------------------------

// "one" as a pronoun: "One can see", "the orange one".
bool is_pronoun_one(const Tokens& tokens, std::size_t at) {
  constexpr auto kModals = std::to_array<std::string_view>(
      {"can", "could", "may", "might", "would", "sees", "should", "must"});
  constexpr auto kCounting = std::to_array<std::string_view>(
      {"is", "are", "only", "just", "exactly", "see", "count", "be", "say", "answer", "there",
       "number", "so", "zero", "or", "and"});
  if (!tokens[at].is("one")) return false;
  const bool more = at + 1 < tokens.size() && tokens[at + 1].is_word();
  if (more && one_of(kModals, tokens[at + 1])) return true;
  // "One of them" is one that is meant, "only one of them" a count.
  const bool ends = !more || tokens[at + 1].is("and");
  const bool part = more && tokens[at + 1].is("of");
  if (part && (at == 0 || !tokens[at - 1].is_word())) return true;
  return (ends || part) && at > 0 && tokens[at - 1].is_word() && !one_of(kCounting, tokens[at - 1]);
}

bool is_number_doubtful(const AnswerPart& part, const Reading& reading) {
  constexpr auto kNoCounts =
      std::to_array<std::string_view>({"thirty", "forty", "fifty", "sixty", "seventy", "eighty",
                                       "ninety", "couple", "pair", "few", "some", "another"});
  const Tokens& tokens = part.tokens;
  if (has_any(tokens, kNoCounts)) return true;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (is_pronoun_one(tokens, at) || tokens[at].is_sign('?')) return true;
    if (tokens[at].is("none") && reading.number != 0) return true;
    if (tokens[at].kind != TokenKind::kNumber) continue;
    if (at + 1 < tokens.size() && tokens[at + 1].is_sign('+')) return true;
    std::size_t before = tokens[at].begin;
    while (before > 0 && part.text[before - 1] == ' ') --before;
    if (before > 0 && part.text[before - 1] == '~') return true;
  }
  return false;
}

// "top left: (1, 2)", "the upper left corner of the carrot": of a box, or of who knows what.
bool is_corner(const Tokens& tokens, std::size_t at) {
  constexpr auto kUpright = std::to_array<std::string_view>({"top", "upper", "bottom", "lower"});
  constexpr auto kSideways = std::to_array<std::string_view>({"left", "right"});
  constexpr auto kWholes = std::to_array<std::string_view>(
      {"of the picture", "of the image", "of the table", "of the frame", "of the scene"});
  if (at + 1 >= tokens.size() || !one_of(kUpright, tokens[at])) return false;
  std::size_t next = at + 1;
  if (tokens[next].is_sign('-')) ++next;
  if (next >= tokens.size() || !one_of(kSideways, tokens[next])) return false;
  ++next;
  if (next < tokens.size() && tokens[next].is("corner")) ++next;
  // "in the upper left of the picture" says where it lies.
  return std::none_of(kWholes.begin(), kWholes.end(),
                      [&](std::string_view whole) { return stands_phrase(tokens, next, whole); });
}

bool is_point_doubtful(const AnswerPart& part) {
  constexpr auto kSizes = std::to_array<std::string_view>({"w", "h", "width", "height"});
  const Tokens& tokens = part.tokens;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const Token& token = tokens[at];
    if (token.is("row") || token.is_sign('?') || is_corner(tokens, at)) return true;
    if (token.is_sign('%') || token.is("percent")) return true;
    const auto sign = [&](std::size_t i, char c) {
      return i < tokens.size() && tokens[i].is_sign(c);
    };
    if (one_of(kSizes, token) && (sign(at + 1, ':') || sign(at + 1, '='))) return true;
    if (token.is("y") && sign(at + 1, ',') && at + 2 < tokens.size() && tokens[at + 2].is("x"))
      return true;
    if (token.kind != TokenKind::kNumber) continue;
    if (is_denied(tokens, at)) return true;
    // "120-140", "120 to 140"
    const bool joined = sign(at + 1, '-') || (at + 1 < tokens.size() && tokens[at + 1].is("to"));
    if (joined && at + 2 < tokens.size() && tokens[at + 2].kind == TokenKind::kNumber) return true;
  }
  return false;
}

}  // namespace

bool asks_for_presence(const ReadContext& context) {
  const std::vector<std::string> asked = plain_words(context.question);
  for (std::size_t at = 0; at + 1 < asked.size(); ++at) {
    if ((asked[at] == "is" || asked[at] == "are") && asked[at + 1] == "there") return true;
    if (asked[at] == "you" && asked[at + 1] == "see") return true;
  }
  return std::find(asked.begin(), asked.end(), "visible") != asked.end();
}

bool is_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                 const Reading& reading) {
  switch (context.form) {
    case plan::QuestionForm::kChoice:
      return is_choice_doubtful(context, part, rule, reading);
    case plan::QuestionForm::kYesNo:
      return is_yesno_doubtful(context, part, rule, reading);
    case plan::QuestionForm::kNumber:
      return is_number_doubtful(part, reading);
    case plan::QuestionForm::kPoint:
      return is_point_doubtful(part);
    case plan::QuestionForm::kFree:
      return false;
  }
  return false;
}

}  // namespace probe::ask
