// Cards that are dealt to two hands: the exact distribution of what one hand's cards add up to.
// What a permutation test of two samples counts. Knows nothing of tests.
#pragma once

#include <cstdint>
#include <map>

namespace probe::stats {

// How many cards show each number, all numbers at least 0 and some card above 0.
using Deck = std::map<std::int64_t, std::int64_t>;

// The chance that `hand` cards (0 < hand < all), dealt without replacement, add up to at least
// `least`, a sum not below its mean. Few cards are counted out, many are summed by
// deal_by_inversion; either is right to nine digits and more, however small the chance (down to
// 1e-300, what is smaller is 0).
double deal_at_least(const Deck& deck, std::int64_t hand, std::int64_t least);

// The two ways, for deal_at_least and its tests. Counting: value by value, over the number of cards
// and their sum so far.
double deal_by_counting(const Deck& deck, std::int64_t hand, std::int64_t least);
// Each card taken by a coin of its own, given that `hand` were taken: the coins' odds e^(a + t v)
// are such that on average `hand` cards with the sum `least` are taken, and the joint distribution
// of number and sum is summed from its Fourier transform in both (ExactSum::at_least_by_inversion
// does so in one).
double deal_by_inversion(const Deck& deck, std::int64_t hand, std::int64_t least);

}  // namespace probe::stats
