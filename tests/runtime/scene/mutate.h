// Damage to a file, the same on every machine: bytes, lengths and numbers that parsers trip over.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace probe::scene::test {

// SplitMix64 (Steele, Lea, Flood 2014) of a counter.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t n) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return static_cast<std::size_t>((z ^ (z >> 31)) % n);
  }

 private:
  std::uint64_t state_;
};

// One to four changes of `file`.
inline std::string mutated(std::string file, std::uint64_t seed) {
  static constexpr std::array<std::uint32_t, 8> kLengths = {
      0, 1, 0xff, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffff0};
  static constexpr std::array<std::string_view, 12> kWords = {
      "0",     "-1", "1e39", "nan", "inf", "4294967295", "4294967296", "99999999999999999999",
      "65536", "\"", "{",    "<"};
  Dice dice(seed);
  for (std::size_t changes = 1 + dice.below(4); changes > 0 && !file.empty(); --changes) {
    const std::size_t at = dice.below(file.size());
    const std::size_t some = 1 + dice.below(std::min<std::size_t>(64, file.size() - at));
    switch (dice.below(8)) {
      case 0:  // a bit
        file[at] = static_cast<char>(file[at] ^ (1 << dice.below(8)));
        break;
      case 1:  // a byte
        file[at] = static_cast<char>(dice.below(256));
        break;
      case 2:  // something is lost
        file.erase(at, some);
        break;
      case 3:  // something stands twice
        file.insert(at, file.substr(at, some));
        break;
      case 4:  // the end is lost
        if (dice.below(4) == 0) file.resize(at);
        break;
      case 5: {  // a length or count in binary
        const std::uint32_t value = kLengths[dice.below(kLengths.size())];
        const std::size_t word = at / 4 * 4;
        if (word + 4 <= file.size()) std::memcpy(file.data() + word, &value, 4);
        break;
      }
      default: {  // a number in text
        const auto digit = [&](std::size_t i) {
          return i < file.size() && file[i] >= '0' && file[i] <= '9';
        };
        std::size_t begin = at;
        while (begin < file.size() && !digit(begin)) ++begin;
        std::size_t end = begin;
        while (digit(end)) ++end;
        const std::string_view word = kWords[dice.below(kWords.size())];
        if (begin < file.size()) file.replace(begin, end - begin, word);
        break;
      }
    }
  }
  return file;
}

}  // namespace probe::scene::test
