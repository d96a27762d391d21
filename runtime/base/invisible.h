// Characters that nobody sees, for texts that must not hide any and for terminals alike.
#pragma once

namespace probe {

// Whether nobody sees a character, wherever it stands: what Unicode ignores by default (spaces of no
// width, marks that turn the direction of reading, tags, selectors) and separators of lines. Not the
// two joiners, without which some scripts are not spelt.
bool is_invisible(char32_t code);

constexpr bool is_joiner(char32_t code) { return code == 0x200c || code == 0x200d; }

// Say how the character before them looks.
constexpr bool is_selector(char32_t code) { return code >= 0xfe00 && code <= 0xfe0f; }

}  // namespace probe
