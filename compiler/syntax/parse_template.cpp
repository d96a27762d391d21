// Templates of instructions, and the slots inside a string: "put {the source} on {target:
// dishware}". The spans of slots point into the string as written.
#include <algorithm>

#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

// Cuts the inside of one pair of braces into words and colons.
class SlotReader {
 public:
  SlotReader(std::string_view inside, FileId file, std::uint32_t begin)
      : inside_(inside), file_(file), begin_(begin) {}

  // What is wrong with it; empty when `slot` could be read.
  std::string read(Slot& slot) {
    Name word;
    if (!take_word(word)) return "a name";
    if (word.text == "avoid" && followed_by_word()) {
      slot.avoid = true;
      take_word(word);
    }
    if (word.text == "the" && followed_by_word()) {
      slot.the = true;
      take_word(word);
    }
    slot.name = word;
    skip_blanks();
    if (at_ < inside_.size() && inside_[at_] == ':') {
      ++at_;
      Name category;
      if (!take_word(category)) return "a category after `:`";
      slot.category = category;
      skip_blanks();
    }
    return at_ == inside_.size() ? "" : "`}`";
  }

  // Where reading stopped.
  std::string_view rest() const { return inside_.substr(at_); }

 private:
  void skip_blanks() {
    while (at_ < inside_.size() && inside_[at_] == ' ') ++at_;
  }
  bool followed_by_word() {
    skip_blanks();
    return at_ < inside_.size() && is_letter(inside_[at_]);
  }
  bool take_word(Name& out) {
    if (!followed_by_word()) return false;
    const std::size_t start = at_;
    while (at_ < inside_.size() && is_word(inside_[at_])) ++at_;
    out.text = inside_.substr(start, at_ - start);
    out.span = {file_, begin_ + static_cast<std::uint32_t>(start),
                begin_ + static_cast<std::uint32_t>(at_)};
    return true;
  }

  std::string_view inside_;
  FileId file_;
  std::uint32_t begin_;
  std::size_t at_ = 0;
};

}  // namespace

DeclNode Parser::template_decl() {
  advance();
  TemplateDecl out;
  out.name = name();
  out.frame = optional_name_after("frame");
  out.text = template_text();
  return out;
}

TemplateText Parser::template_text() {
  TemplateText out;
  out.text = string();
  if (prev_ != kNoToken && unclosed_string_ == prev_)
    return out;  // has been reported; braces in it mean nothing
  const std::string_view raw = out.text.raw;
  const std::uint32_t base = out.text.span.begin + 1;
  const auto span = [&](std::size_t begin, std::size_t end) {
    return Span{file_.id, base + static_cast<std::uint32_t>(begin),
                base + static_cast<std::uint32_t>(end)};
  };
  // Mistakes inside a string do not disturb the grammar around it: reported, and the declaration is
  // not complete.
  const auto mistake = [&](const Span& where, std::string message) {
    complete_ = false;
    Diagnostic* error = errors_.report(Code::P0406, where, std::move(message));
    if (error != nullptr)
      error->help("a slot is `{source}`, `{the target}`, `{avoid the plate}` or `{source: drink}`");
  };
  std::string literal;
  const auto flush = [&] {
    if (!literal.empty()) out.parts.emplace_back(std::move(literal));
    literal.clear();
  };
  for (std::size_t at = 0; at < raw.size();) {
    const char c = raw[at];
    if (c == '\\' && at + 1 < raw.size()) {
      literal += raw[at + 1] == 'n' ? '\n' : raw[at + 1];
      at += 2;
      continue;
    }
    if (c == '}') {
      mistake(span(at, at + 1), "found `}` without its `{`");
      return out;
    }
    if (c != '{') {
      literal += c;
      ++at;
      continue;
    }
    const std::size_t close = raw.find_first_of("{}", at + 1);
    if (close == std::string_view::npos || raw[close] == '{') {
      mistake(span(at, at + 1), "found `{` without its `}`");
      return out;
    }
    Slot slot;
    slot.span = span(at, close + 1);
    SlotReader reader(raw.substr(at + 1, close - at - 1), file_.id,
                      base + static_cast<std::uint32_t>(at) + 1);
    const std::string wanted = reader.read(slot);
    if (!wanted.empty()) {
      const std::string found =
          reader.rest().empty() ? "}" : std::string(reader.rest().substr(0, 40));
      mistake(slot.span, "found `" + found + "` in a slot, expected " + wanted);
      return out;
    }
    flush();
    out.parts.emplace_back(std::move(slot));
    at = close + 1;
  }
  flush();
  return out;
}

}  // namespace probe::syntax
