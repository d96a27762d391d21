#include "runtime/base/printable.h"

#include "runtime/base/utf8.h"

namespace probe {

bool is_unsafe(char32_t code) {
  return is_control(code) || code == 0x061c || (code >= 0x200e && code <= 0x200f) ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2060 && code <= 0x206f) ||
         code == 0xfeff || (code >= 0xfff9 && code <= 0xfffb) ||
         (code >= 0xe0000 && code <= 0xe007f);
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
