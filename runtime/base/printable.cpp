#include "runtime/base/printable.h"

#include "runtime/base/utf8.h"

namespace probe {

std::string printable(std::string_view text, std::size_t most) {
  std::string clean;
  while (!text.empty()) {
    const Utf8Char first = first_utf8(text);
    const std::string_view sequence = text.substr(0, first.bytes == 0 ? 1 : first.bytes);
    if (clean.size() + sequence.size() > most) return clean + "...";
    if (first.bytes == 0) {
      clean += '?';
    } else if (is_control(first.code)) {
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
