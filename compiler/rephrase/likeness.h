// When two wordings are too alike for one to be trained on and the other to be held out or asked:
// the one measure of splits and of leaks.
#pragma once

#include <string>
#include <string_view>

namespace probe::rephrase {

// Equal for wordings that are alike: their words in lower case, sorted, without articles and signs,
// without what only asks politely ("please", "could you"), and with one word for words of place
// that say the same ("onto", "on top of": relations.h). Apostrophes leave no gap, so "rabbit's" is
// "rabbits". Nothing but polite words are their own likeness.
std::string likeness(std::string_view wording);

}  // namespace probe::rephrase
