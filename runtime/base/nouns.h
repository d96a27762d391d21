// What English makes of a noun: its plural, and the article before it.
#pragma once

#include <string>
#include <string_view>

namespace probe {

// As one would write it: "boxes", "knives", "keys".
std::string plural_of(std::string_view noun);

// Whether one noun is the other in the plural, in any spelling that is in use ("scarfs",
// "scarves"), or they are the same. Of folded words.
bool is_same_noun(std::string_view a, std::string_view b);

// "a", "an" or "the", folded.
bool is_article(std::string_view word);

// "a carrot", "an eggplant". By the first letter, and what is spoken otherwise than written: "an
// hour", "a USB stick", "a one".
std::string with_indefinite_article(std::string_view words);

}  // namespace probe
