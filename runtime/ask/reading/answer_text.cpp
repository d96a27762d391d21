#include "runtime/ask/reading/answer_text.h"

#include <algorithm>
#include <array>
#include <optional>

#include "runtime/base/utf8.h"

namespace probe::ask {
namespace {

constexpr auto kThoughtTags = std::to_array<std::string_view>(
    {"think", "thinking", "reasoning", "thought", "analysis", "seed:think"});
// Marks of thoughts that are no tags; in small letters.
struct ThoughtMark {
  std::string_view mark;
  bool closes;
};
constexpr ThoughtMark kThoughtMarks[] = {
    {"\u25c1think\u25b7", false},
    {"\u25c1/think\u25b7", true},
    {"[think]", false},
    {"[/think]", true},
    {"<|start_thinking|>", false},
    {"<|end_thinking|>", true},
    {"<|begin_of_thought|>", false},
    {"<|end_of_thought|>", true},
    {"<|channel|>analysis", false},
    {"<|channel|>commentary", false},
    {"<|channel|>final<|message|>", true},
};

// What only formats, or ends a text, and says nothing.
constexpr auto kFormatTags = std::to_array<std::string_view>(
    {"b",           "i",          "u",           "em",       "strong", "br",
     "p",           "code",       "pre",         "span",     "div",    "sub",
     "sup",         "s",          "eos",         "bos",      "pad",    "end_of_turn",
     "|im_end|",    "|im_start|", "|endoftext|", "|eot_id|", "|end|",  "|begin_of_box|",
     "|end_of_box|"});

// Any one of them, one word after the other, is a refusal. Apostrophes are left out as in tokens.
constexpr auto kRefusals = std::to_array<std::string_view>({"i cant",
                                                            "i cannot",
                                                            "i can not",
                                                            "i am unable",
                                                            "im unable",
                                                            "unable to",
                                                            "not able to",
                                                            "im sorry",
                                                            "i am sorry",
                                                            "as an ai",
                                                            "i dont know",
                                                            "i do not know",
                                                            "i dont see",
                                                            "i do not see",
                                                            "i wont",
                                                            "cannot determine",
                                                            "cant determine",
                                                            "cannot be determined",
                                                            "cant be determined",
                                                            "cannot answer",
                                                            "cannot assist",
                                                            "cannot see",
                                                            "cant see",
                                                            "cant tell",
                                                            "cannot tell",
                                                            "no image",
                                                            "no picture",
                                                            "not possible to",
                                                            "impossible to"});

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

struct TagAt {
  bool closes = false;
  std::size_t bytes = 0;  // of the whole tag
};

bool is_same_text(std::string_view low, std::string_view text) {
  return text.size() >= low.size() && std::equal(low.begin(), low.end(), text.begin(),
                                                 [](char a, char b) { return a == lower(b); });
}

// The mark of thoughts at `at`, in any case; a tag may have attributes.
std::optional<TagAt> thought_mark(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  for (const ThoughtMark& mark : kThoughtMarks) {
    if (is_same_text(mark.mark, rest)) return TagAt{mark.closes, mark.mark.size()};
  }
  if (rest[0] != '<') return std::nullopt;
  const bool closes = rest.size() > 1 && rest[1] == '/';
  const std::string_view inner = rest.substr(closes ? 2 : 1);
  for (const std::string_view name : kThoughtTags) {
    if (!is_same_text(name, inner) || inner.size() == name.size()) continue;
    std::size_t end = name.size();
    constexpr std::size_t kLongest = 100;  // of attributes, bytes
    if (inner[end] == ' ' && !closes) end = inner.substr(0, end + kLongest).find_first_of("><\n");
    if (end == inner.npos || inner[end] != '>') continue;
    return TagAt{closes, end + 1 + (closes ? 2U : 1U)};
  }
  return std::nullopt;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_plain_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

// Whether a word may go on with what stands at `at`, and for how many bytes.
std::size_t word_bytes(std::string_view text, std::size_t at) {
  const char c = text[at];
  if (is_digit(c) || is_plain_letter(c)) return 1;
  if (static_cast<unsigned char>(c) < 0x80) return 0;
  const Utf8Char character = first_utf8(text.substr(at));
  // Beyond ASCII everything that is no sign of prose is part of words.
  constexpr std::u32string_view kSigns =
      U"\ufffd\u00a1\u00a7\u00ab\u00b6\u00b7\u00bb\u00bf\u00b0\u00b1\u00d7\u00f7";
  if (character.bytes == 0 || kSigns.find(character.code) != kSigns.npos) return 0;
  const bool is_punctuation = (character.code >= 0x2000 && character.code < 0x2070) ||
                              (character.code >= 0x2190 && character.code < 0x2c00) ||
                              (character.code >= 0x3000 && character.code < 0x3030);
  return is_punctuation ? 0 : character.bytes;
}

// A tag that only formats, whole, at `at`; 0 when it is none.
std::size_t format_tag_bytes(std::string_view text, std::size_t at) {
  constexpr std::size_t kLongest = 40;
  const std::size_t end = text.substr(at, kLongest).find('>');
  if (end == std::string_view::npos) return 0;
  std::string name;
  for (const char c : text.substr(at + 1, end - 1)) name += lower(c);
  if (name.starts_with('/')) name.erase(0, 1);
  if (name.ends_with('/')) name.pop_back();
  while (name.ends_with(' ')) name.pop_back();
  const bool known = std::find(kFormatTags.begin(), kFormatTags.end(), name) != kFormatTags.end();
  return known ? end + 1 : 0;
}

class Tokenizer {
 public:
  explicit Tokenizer(std::string_view text) : text_(text) {}

  Tokens run() {
    while (at_ < text_.size()) step();
    return std::move(tokens_);
  }

 private:
  void step() {
    const char c = text_[at_];
    if (c == '\n') {
      add({.kind = TokenKind::kBreak, .text = "\n"}, 1);
    } else if (c == ' ' || c == '*' || c == '_' || c == '`' || c == '"' || c == '\'' || c == '$' ||
               c == '#' || c == '~' || c == '{' || c == '}') {
      spaced_ = spaced_ || c == ' ' || c == '_';
      ++at_;
    } else if (c == '\\') {
      ++at_;  // and the command after it, which has no blank in between
      while (at_ < text_.size() && is_plain_letter(text_[at_])) ++at_;
    } else if (c == '<' && format_tag_bytes(text_, at_) > 0) {
      at_ += format_tag_bytes(text_, at_);
      spaced_ = true;
    } else if (is_digit(c)) {
      number();
    } else if (word_bytes(text_, at_) > 0) {
      word();
    } else {
      const std::size_t bytes = std::max<std::size_t>(first_utf8(text_.substr(at_)).bytes, 1);
      add({.kind = TokenKind::kSign, .text = std::string(text_.substr(at_, bytes))}, bytes);
    }
  }

  void number() {
    std::size_t end = at_;
    while (end < text_.size() && is_digit(text_[end])) ++end;
    const bool has_unit = text_.substr(end, 2) == "px" &&
                          (end + 2 >= text_.size() || word_bytes(text_, end + 2) == 0);
    if (end < text_.size() && word_bytes(text_, end) > 0 && !has_unit) return word();  // "3rd"
    if (end + 1 < text_.size() && text_[end] == '.' && is_digit(text_[end + 1])) {
      ++end;
      while (end < text_.size() && is_digit(text_[end])) ++end;
    }
    add({.kind = TokenKind::kNumber, .text = std::string(text_.substr(at_, end - at_))}, end - at_);
  }

  void word() {
    std::string letters;
    std::size_t end = at_;
    while (end < text_.size()) {
      if (text_[end] == '\'' && !letters.empty()) {
        if (end + 1 >= text_.size() || word_bytes(text_, end + 1) == 0) break;
        ++end;
        continue;
      }
      const std::size_t bytes = word_bytes(text_, end);
      if (bytes == 0) break;
      letters += text_.substr(end, bytes);
      end += bytes;
    }
    std::string folded = fold_case(letters);
    const bool capital = letters[0] >= 'A' && letters[0] <= 'Z';
    const std::size_t bytes = end - at_;
    add({.kind = TokenKind::kWord, .text = std::move(folded), .capital = capital}, bytes);
    // A hyphen inside a word parts it, as a blank would.
    const bool is_hyphen = at_ + 1 < text_.size() && text_[at_] == '-' &&
                           word_bytes(text_, at_ + 1) > 0 && !is_digit(text_[at_ + 1]);
    if (is_hyphen) {
      ++at_;
      spaced_ = true;
    }
  }

  void add(Token token, std::size_t bytes) {
    token.spaced = spaced_;
    token.begin = at_;
    token.end = at_ + bytes;
    tokens_.push_back(std::move(token));
    spaced_ = false;
    at_ += bytes;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool spaced_ = false;
  Tokens tokens_;
};

}  // namespace

std::string without_thoughts(std::string_view raw) {
  std::string kept;
  bool inside = false;
  std::size_t from = 0;
  constexpr std::string_view kFirsts = "<[\xe2";  // of marks
  for (std::size_t at = raw.find_first_of(kFirsts); at != std::string_view::npos;
       at = raw.find_first_of(kFirsts, at + 1)) {
    const auto tag = thought_mark(raw, at);
    if (!tag) continue;
    if (tag->closes) {
      if (!inside) kept.clear();  // its beginning was not in the answer
      inside = false;
    } else if (!inside) {
      kept += raw.substr(from, at - from);
      inside = true;
    }
    from = at + tag->bytes;
    at = from - 1;
  }
  if (!inside) kept += raw.substr(from);
  return kept;
}

std::string without_colours(std::string_view text) {
  constexpr std::size_t kLongest = 32;  // bytes of a sequence
  const auto is_parameter = [](char c) { return c >= ' ' && c <= '?'; };
  const auto is_final = [](char c) { return c >= '@' && c <= '~'; };
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = text.find("\x1b["); at != text.npos; at = text.find("\x1b[", at)) {
    std::size_t end = at + 2;
    while (end < std::min(text.size(), at + kLongest) && is_parameter(text[end])) ++end;
    if (end < text.size() && is_final(text[end])) {
      out += text.substr(from, at - from);
      out += ' ';
      from = end + 1;
    }
    at = end;
  }
  out += text.substr(from);
  return out;
}

std::string plain_form(std::string_view text) {
  const std::string form = compatible_form(text);
  std::string out;
  out.reserve(form.size());
  std::string_view rest = form;
  while (!rest.empty()) {
    const Utf8Char character = first_utf8(rest);
    const std::size_t bytes = std::max<std::size_t>(character.bytes, 1);
    switch (character.code) {
      case U'\u2018':
      case U'\u2019':
      case U'\u201b':
      case U'\u02bc':
        out += '\'';
        break;
      case U'\u201c':
      case U'\u201d':
      case U'\u201e':
      case U'\u00ab':
      case U'\u00bb':
        out += '"';
        break;
      case U'\u2212':
      case U'\u2010':
      case U'\u2011':
        out += '-';
        break;
      case U'\u2013':
      case U'\u2014':
        out += " - ";
        break;
      case U'\u2028':
      case U'\u2029':
        out += '\n';
        break;
      case U'\ufffd':
        out += ' ';
        break;
      default:
        if (character.code == '\r') {
          if (rest.size() < 2 || rest[1] != '\n') out += '\n';
        } else if (character.code != '\n' && is_control(character.code)) {
          out += ' ';
        } else {
          out += rest.substr(0, bytes);
        }
    }
    rest.remove_prefix(bytes);
  }
  return out;
}

Tokens tokens_of(std::string_view text) { return Tokenizer(text).run(); }

bool is_one_of(const Token& token, std::span<const std::string_view> words) {
  return token.is_word() && std::find(words.begin(), words.end(), token.text) != words.end();
}

bool has_one_of(std::span<const Token> tokens, std::span<const std::string_view> words) {
  return std::any_of(tokens.begin(), tokens.end(),
                     [&](const Token& token) { return is_one_of(token, words); });
}

bool stands_phrase(std::span<const Token> tokens, std::size_t at, std::string_view phrase) {
  while (true) {
    const std::size_t blank = phrase.find(' ');
    if (at >= tokens.size() || !tokens[at].is_word() || !tokens[at].is(phrase.substr(0, blank)))
      return false;
    if (blank == std::string_view::npos) return true;
    phrase.remove_prefix(blank + 1);
    ++at;
  }
}

bool has_phrase(std::span<const Token> tokens, std::span<const std::string_view> phrases) {
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    for (const std::string_view phrase : phrases) {
      if (stands_phrase(tokens, at, phrase)) return true;
    }
  }
  return false;
}

bool is_refusal(std::span<const Token> tokens) { return has_phrase(tokens, kRefusals); }

}  // namespace probe::ask
