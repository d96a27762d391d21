// Values along an axis as findings store them (in the unit that people read), for who has no space
// at hand: their texts, and how far along a side they are.
#pragma once

#include <string>
#include <string_view>

#include "runtime/stats/intervals.h"

namespace probe::search {

// "12 of 40".
std::string k_of_n(const stats::Count& count);

// "0.31", "-2.5cm", "x 0.31", "3 steps": as space::value_text writes the same value.
std::string shown_text(std::string_view axis, std::string_view unit, double value);

// From 0 at `own` to 1 at `end`; of axes whose equal factors are equal steps, by the factor. Values
// beyond are at 0 or 1.
double share_of_side(std::string_view axis, double own, double end, double value);

}  // namespace probe::search
