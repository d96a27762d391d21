#include "runtime/base/printable.h"

#include "runtime/base/invisible.h"
#include "runtime/base/utf8.h"

namespace probe {

bool is_unsafe(char32_t code) {
  return is_control(code) || (is_invisible(code) && !is_selector(code));
}

std::string shown(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Utf8Char first = first_utf8(text);
    const std::string_view sequence = text.substr(0, first.bytes == 0 ? 1 : first.bytes);
    const bool stays = first.code == '\n' || first.code == '\t';
    if (first.bytes == 0 || (is_unsafe(first.code) && !stays)) {
      out += "\xef\xbf\xbd";
    } else {
      out += sequence;
    }
    text.remove_prefix(sequence.size());
  }
  return out;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string clean;
  while (!text.empty()) {
    const Utf8Char first = first_utf8(text);
    const std::string_view sequence = text.substr(0, first.bytes == 0 ? 1 : first.bytes);
    if (clean.size() + sequence.size() > most) return clean + "...";
    if (first.bytes == 0) {
      clean += '?';
    } else if (is_unsafe(first.code)) {
      clean += ' ';
    } else {
      clean += sequence;
    }
    text.remove_prefix(sequence.size());
  }
  return clean;
}

bool is_printable(std::string_view text) { return printable(text, text.size()) == text; }

}  // namespace probe
