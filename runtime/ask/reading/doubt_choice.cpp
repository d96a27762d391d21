// What makes a choice doubtful that a rule read.
#include <algorithm>
#include <array>

#include "runtime/ask/reading/doubt_words.h"
#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_letters.h"

namespace probe::ask {
namespace {

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
  while (from < tokens.size() && is_one_of(tokens[from], kLeading)) ++from;
  constexpr auto kOthers = std::to_array<std::string_view>({"others", "other", "rest"});
  if (from == tokens.size() || !is_one_of(tokens[from], kOthers)) return at;
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
    if (is_one_of(tokens[at], kNearly) && !describes) return true;
  }
  return false;
}

// The first word behind `at`, before its sentence ends; a sign of a letter ("B.") ends it, too.
std::size_t word_behind(const Tokens& tokens, std::size_t at) {
  while (at < tokens.size() && tokens[at].kind == TokenKind::kSign && !tokens[at].is_end()) ++at;
  return at;
}

// "B is not the one", "The carrot isn't": a verb right behind what ends at `end`, and a denial.
bool is_followed_by_denial(const Tokens& tokens, std::size_t end) {
  constexpr std::size_t kFar = 4;  // tokens
  const std::size_t verb = word_behind(tokens, end);
  if (verb >= tokens.size()) return false;
  if (is_against(tokens, verb, kDenials)) return true;
  if (!is_one_of(tokens[verb], kAreVerbs)) return false;
  for (std::size_t at = verb; at < tokens.size() && at < verb + kFar; ++at) {
    if (tokens[at].kind != TokenKind::kWord) return false;
    if (is_against(tokens, at, kDenials)) return true;
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
    if (is_one_of(tokens[next], kVerdicts)) return true;
    if (chosen && (is_followed_by_denial(tokens, at + 1) || is_one_of(tokens[next], kMore)))
      return true;
    if (tokens[next].is("is")) (chosen ? is_chosen : is_other) = true;
  }
  return is_chosen && is_other;
}

bool has_amount(const Tokens& tokens, std::size_t from, std::size_t to) {
  for (std::size_t at = from; at < to; ++at) {
    if (tokens[at].kind == TokenKind::kNumber || tokens[at].is_sign('%')) return true;
  }
  return false;
}

// "B is a trap", "Discard B", "B is out": words about the letter that is taken, in its clause, that
// are no plain ones.
bool is_letter_talked_of(const ReadContext& context, const AnswerPart& part, const LetterAt& at,
                         std::size_t from) {
  constexpr auto kConcluding =
      std::to_array<std::string_view>({"so", "thus", "hence", "therefore"});
  const Tokens& tokens = part.tokens;
  // "The others are wrong, so it is B" concludes.
  for (std::size_t i = at.begin; i > from; --i) {
    if (is_one_of(tokens[i - 1], kConcluding)) {
      from = i - 1;
      break;
    }
  }
  if (!is_plain_speech(context, part, from, at.begin) || has_amount(tokens, from, at.begin))
    return true;
  std::size_t behind = at.end;
  bool labelled = false;
  while (behind < tokens.size() && !tokens[behind].is_end() && !labelled) {
    const auto label = std::ranges::lower_bound(part.named, behind, {}, &Named::begin);
    labelled = label != part.named.end() && label->begin == behind;
    if (labelled) {
      behind = label->end;
    } else if (tokens[behind].is_word() && !is_article(tokens[behind].text)) {
      break;
    } else {
      ++behind;
    }
  }
  const bool ended =
      tokens[at.end - 1].is_sign('.') || (at.end < tokens.size() && tokens[at.end].is_end());
  if (ended && !labelled) return false;
  if (!labelled) behind = at.end;
  // A sign that parts the label from words about it is passed; a comma begins something else.
  while (behind < tokens.size() && is_decoration(tokens[behind]) && !tokens[behind].is_end() &&
         !tokens[behind].is_sign(',') && !tokens[behind].is_sign(';'))
    ++behind;
  std::size_t end = end_of_clause(tokens, behind);
  for (std::size_t i = behind; i < end; ++i) {
    if (tokens[i].is_sign(':')) end = i;
  }
  return !is_plain_speech(context, part, behind, end) || has_amount(tokens, behind, end);
}

// "The thing on the plate" is not the plate, "put it on the plate" and "on the plate" are.
bool is_beside(const Tokens& tokens, const Named& name, std::size_t from) {
  constexpr auto kBeside = std::to_array<std::string_view>(
      {"on", "onto", "in", "into", "at", "of", "by", "to", "with", "from"});
  constexpr auto kPutting =
      std::to_array<std::string_view>({"put", "place", "placed", "move", "moved", "go", "goes"});
  std::size_t at = name.begin;
  while (at > from && tokens[at - 1].is_word() && is_article(tokens[at - 1].text)) --at;
  if (at == from || !is_one_of(tokens[at - 1], kBeside)) return false;
  if (at - 1 == from && !tokens[from].is("of")) return false;
  const auto before = std::span(tokens).subspan(from, at - 1 - from);
  return tokens[at - 1].is("of") || std::ranges::none_of(before, [&](const Token& token) {
           return is_one_of(token, kPutting);
         });
}

// What else the answer says against the option that is taken.
bool is_choice_spoken_against(const ReadContext& context, const AnswerPart& part,
                              const ReadRule& rule, const Reading& reading) {
  const Tokens& tokens = part.tokens;
  std::size_t from = 0;
  if (rule.name.starts_with("letter")) {
    const auto letters = letters_of(tokens, part.named);
    const auto is_taken = [&](const LetterAt& at) {
      return at.letter < context.options.size() &&
             context.options[at.letter].option == reading.option;
    };
    const auto first = rule.name == "letter last"
                           ? std::find_if(letters.rbegin(), letters.rend(), is_taken).base()
                           : std::find_if(letters.begin(), letters.end(), is_taken);
    if (rule.name == "letter last" && first != letters.begin()) {
      from = begin_of_sentence(tokens, (first - 1)->begin);
      if (is_letter_talked_of(context, part, *(first - 1), from)) return true;
    } else if (rule.name != "letter last" && first != letters.end()) {
      from = begin_of_sentence(tokens, first->begin);
      if (is_letter_talked_of(context, part, *first, from)) return true;
    }
  } else {
    const auto name = std::find_if(part.named.begin(), part.named.end(), [&](const Named& one) {
      return context.options[one.place].option == reading.option;
    });
    if (name == part.named.end()) return false;
    from = begin_of_sentence(tokens, name->begin);
    if (rule.name == "name in a sentence" &&
        (!is_plain_speech(context, part, from, end_of_clause(tokens, name->end)) ||
         is_beside(tokens, *name, from)))
      return true;
  }
  return speaks_against(context, part, from, tokens.size(), reading);
}

}  // namespace

bool is_choice_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                        const Reading& reading) {
  if (is_choice_spoken_against(context, part, rule, reading)) return true;
  const Tokens& tokens = part.tokens;
  const Tokens chosen = about_the_chosen(context, part);
  // "None of these. B"
  constexpr auto kNoneAtAll = std::to_array<std::string_view>({"none", "neither"});
  if (has_against(chosen, kRejections) || has_one_of(chosen, kNoneAtAll) || is_nearly(tokens))
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
  if (rule.name.starts_with("letter")) return is_letter_doubtful(context, chosen, reading);
  for (const Token& token : tokens) {
    if (token.is("or")) return true;
  }
  for (const Named& name : part.named) {
    if (context.options[name.place].option != reading.option) continue;
    if (is_followed_by_denial(tokens, name.end) || is_denied(tokens, name.begin)) return true;
  }
  return false;
}

}  // namespace probe::ask
