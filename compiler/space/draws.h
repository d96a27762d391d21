// Numbers that follow from a point alone.
#pragma once

#include <cstdint>
#include <string_view>

namespace probe::space {

// In [0, 1), of 53 bits; another one for each `what` and each number.
double draw(std::uint64_t of, std::string_view what, std::uint64_t number = 0);

}  // namespace probe::space
