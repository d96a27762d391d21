// Which words of place say the same: what proves that two templates ask for one relation, and makes
// two wordings too alike for different splits.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace probe::rephrase {

struct Relation {
  std::string_view name;
  std::string_view words;  // what stands before a place, without articles; between bars
};

// Words that are not here ("to", "over", "with") leave it to the frame of a template.
inline constexpr auto kRelations = std::to_array<Relation>({
    {"on", "on|onto|upon|atop|on top of"},
    {"in", "in|into|inside|within"},
    {"outside", "outside"},
    {"under", "under|underneath|below|beneath"},
    {"beside", "beside|near|by|alongside|next to|close to"},
    {"behind", "behind"},
    {"before", "before|in front of"},
    {"left", "left of"},
    {"right", "right of"},
    {"from", "from|off|out of"},
    {"around", "around"},
    {"between", "between"},
    {"against", "against"},
    {"through", "through"},
    {"towards", "towards|toward"},
});

}  // namespace probe::rephrase
