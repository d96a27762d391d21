#include "runtime/libero/sexpr.h"

#include <optional>

namespace probe::libero {
namespace {

constexpr std::size_t kDeepest = 32;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

class SexprReader {
 public:
  SexprReader(std::string_view text, std::string_view path) : text_(text), path_(path) {}

  Result<Sexprs> read() {
    while (skip_blanks()) {
      if (is_over_) return wrong("nothing stands behind the list that the file is");
      if (text_[at_] == '(') {
        PROBE_TRY(begin());
      } else if (text_[at_] == ')') {
        PROBE_TRY(end());
      } else {
        PROBE_TRY(word());
      }
    }
    if (!open_.empty()) {
      spot_ = read_.nodes[open_.back()].spot;
      return wrong("this `(` is never closed");
    }
    if (!is_over_) return wrong("expected a list in brackets, found an empty file");
    return std::move(read_);
  }

 private:
  Failure wrong(std::string what) const {
    return {Fault::kUsage, std::move(what), place_of(path_, spot_)};
  }

  void step() {
    if (text_[at_++] == '\n') {
      ++spot_.line;
      spot_.column = 1;
    } else {
      ++spot_.column;
    }
  }

  bool skip_blanks() {
    while (at_ < text_.size()) {
      if (text_[at_] == ';') {
        while (at_ < text_.size() && text_[at_] != '\n') step();
      } else if (is_space(text_[at_])) {
        step();
      } else {
        return true;
      }
    }
    return false;
  }

  std::uint32_t add(Sexpr node) {
    const auto index = static_cast<std::uint32_t>(read_.nodes.size());
    if (!open_.empty()) read_.nodes[open_.back()].items.push_back(index);
    read_.nodes.push_back(std::move(node));
    return index;
  }

  Status begin() {
    if (open_.size() >= kDeepest)
      return wrong("lists more than " + std::to_string(kDeepest) + " deep");
    open_.push_back(add({true, {}, {}, spot_}));
    step();
    return {};
  }

  Status end() {
    if (open_.empty()) return wrong("this `)` closes nothing");
    read_.root = open_.back();
    open_.pop_back();
    is_over_ = open_.empty();
    step();
    return {};
  }

  Status word() {
    if (open_.empty()) return wrong("expected `(`, found a word");
    const Spot spot = spot_;
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != '(' && text_[at_] != ')' &&
           text_[at_] != ';') {
      step();
    }
    add({false, text_.substr(from, at_ - from), {}, spot});
    return {};
  }

  std::string_view text_, path_;
  std::size_t at_ = 0;
  Spot spot_;
  bool is_over_ = false;
  Sexprs read_;
  std::vector<std::uint32_t> open_;
};

}  // namespace

std::string place_of(std::string_view path, Spot spot) {
  return std::string(path) + ":" + std::to_string(spot.line) + ":" + std::to_string(spot.column);
}

std::string_view Sexprs::head(const Sexpr& list) const {
  return list.items.empty() ? std::string_view() : nodes[list.items.front()].word;
}

Result<Sexprs> read_sexpr(std::string_view text, std::string_view path) {
  return SexprReader(text, path).read();
}

}  // namespace probe::libero
