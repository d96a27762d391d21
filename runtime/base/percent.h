// How percentages and points are written: one rule for tables, sentences and the page, halves away
// from zero. The page's own is runtime/report/page/src/format.ts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace probe {

// k of n in percent with one decimal, rounded on the whole numbers: 63 of 1200 is "5.3", where
// printf, halves to even, has 5.2. "0.0" for n = 0.
std::string percent_text(std::int64_t k, std::int64_t n);

// The counts of `n` episodes (at least one) whose percentages are nearest to one that was written
// with so many decimals; it fits when one of them rounds to it, halves either way. (The GRIM test of
// N. Brown and J. Heathers, "The GRIM test", 2017, for rates.)
struct NearestCounts {
  bool fits = false;
  std::int64_t below = 0, above = 0;  // k of n; equal when it fits
};
NearestCounts nearest_counts(double percent, int decimals, std::int64_t n);

// A finite value to `digits` decimals, halves away from zero; what is within 1e-9 of a half is one,
// since 100 times a rate is seldom exact. Never -0. As a number for JSON, and as text.
double rounded(double value, int digits);
std::string decimal_text(double value, int digits);
// The same with a sign: "+5.3", "-0.1", "+0.0".
std::string signed_text(double value, int digits);

// Two rates (0..1) in whole percents, with decimals where those would hide that they differ:
// "43-79", "99.7-100.0".
std::string percent_range(double low, double high, std::string_view between);

}  // namespace probe
