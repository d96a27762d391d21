// Names of texts from names of files and of what they hold.
#pragma once

#include <string>
#include <string_view>

namespace probe::assets {

// What is no letter, digit or `_` becomes `_`; what does not begin with a letter gets `first`
// before it: "2 cups" with "the" is "the_2_cups". Nothing at all is "unnamed".
std::string identifier_of(std::string_view name, std::string_view first);

}  // namespace probe::assets
