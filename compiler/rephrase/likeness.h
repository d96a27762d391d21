// When two wordings are too alike for one to be trained on and the other to be asked: up to case,
// articles, punctuation and the order of words.
#pragma once

#include <string>
#include <string_view>

namespace probe::rephrase {

// Equal for wordings that are alike: their words in lower case, sorted, without articles and signs.
// Apostrophes leave no gap, so "rabbit's" is "rabbits".
std::string likeness(std::string_view wording);

// The same without what only asks politely ("please", "could you"): who was trained on the one form
// has seen the other. Nothing but such words are their own likeness.
std::string likeness_without_courtesy(std::string_view wording);

}  // namespace probe::rephrase
