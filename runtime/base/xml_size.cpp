#include "runtime/base/xml_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace probe {
namespace {

// As TinyXML has it, whatever the locale: bytes above 126 are letters.
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) > 126;
}
bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  XmlSize run() {
    while (!size_.is_odd) {
      at_ = text_.find('<', at_);
      if (at_ == text_.npos || at_ + 1 >= text_.size()) break;
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("<!--")) {
        skip_behind("-->", 4);
      } else if (rest.starts_with("<![CDATA[")) {
        skip_behind("]]>", 9);
      } else if (rest[1] == '?') {
        skip_declaration();
      } else if (rest[1] == '/') {
        open_ -= open_ > 0 ? 1 : 0;
        at_ += 2;
      } else if (begins_name(rest[1])) {
        take_tag();
      } else {
        skip_behind(">", 1);
      }
    }
    return size_;
  }

 private:
  void skip_behind(std::string_view end, std::size_t from) {
    const std::size_t found = text_.find(end, at_ + from);
    at_ = found == text_.npos ? text_.size() : found + end.size();
  }

  bool skip_blanks() {
    const std::size_t before = at_;
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return at_ > before;
  }
  bool skip_name() {
    const std::size_t before = at_;
    while (at_ < text_.size() &&
           (begins_name(text_[at_]) ||
            std::string_view("-.:0123456789").find(text_[at_]) != std::string_view::npos))
      ++at_;
    return at_ > before;
  }

  // `<?xml version="1.0"?>`: anything else could end elsewhere than it seems to.
  void skip_declaration() {
    at_ += 2;
    skip_name();
    while (skip_blanks() && at_ < text_.size() && text_[at_] != '?') {
      const bool has_name = skip_name();
      skip_blanks();
      if (!has_name || !take('=')) return give_up();
      skip_blanks();
      const char quote = at_ < text_.size() ? text_[at_] : '\0';
      if (quote != '"' && quote != '\'') return give_up();
      const std::size_t end = text_.find_first_of(quote == '"' ? "\"<>" : "'<>", at_ + 1);
      if (end == text_.npos || text_[end] != quote) return give_up();
      at_ = end + 1;
    }
    if (!take('?') || !take('>')) give_up();
  }
  bool take(char wanted) {
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }
  void give_up() { size_.is_odd = true; }

  void take_tag() {
    ++size_.elements;
    size_.depth = std::max(size_.depth, open_ + 1);
    std::size_t attributes = 0;
    char quote = '\0';
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (quote != '\0') {
        if (c == quote) quote = '\0';
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '=') {
        ++attributes;
      } else if (c == '>') {
        if (text_[at_ - 1] != '/') ++open_;
        ++at_;
        break;
      }
    }
    size_.attributes = std::max(size_.attributes, attributes);
  }

  std::string_view text_;
  std::size_t at_ = 0, open_ = 0;
  XmlSize size_;
};

}  // namespace

XmlSize xml_size(std::string_view text) { return Scan(text).run(); }

Status check_xml_size(std::string_view text, Fault code, const std::string& path,
                      std::size_t* elements) {
  // TinyXML recurses once a level, and so does who walks over a tree of it.
  constexpr std::size_t kDeepest = 500, kMostAttributes = 100, kMostElements = 100'000;
  const auto fail = [&](std::string message) { return Failure{code, std::move(message), path}; };
  const XmlSize size = xml_size(text);
  *elements += size.elements;
  if (size.is_odd) return fail("a `<?` that is no declaration");
  if (size.depth > kDeepest) return fail(fmt::format("elements nested deeper than {}", kDeepest));
  if (size.attributes > kMostAttributes)
    return fail(fmt::format("an element of more than {} attributes", kMostAttributes));
  if (*elements > kMostElements) return fail(fmt::format("more than {} elements", kMostElements));
  return {};
}

}  // namespace probe
