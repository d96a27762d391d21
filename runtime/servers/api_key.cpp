#include "runtime/servers/api_key.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdlib>

namespace probe::servers {
namespace {

// A shorter part says little of a key and is found in other words too.
constexpr std::size_t kTelling = 6;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char low = lower(c);
  return low >= 'a' && low <= 'f' ? low - 'a' + 10 : -1;
}

// One character of a text in which some may be escaped as in a URL.
struct Character {
  char value;
  std::size_t bytes;
};

Character character_at(std::string_view text, std::size_t at) {
  if (text[at] == '%' && text.size() - at > 2) {
    const int high = hex_digit(text[at + 1]), low = hex_digit(text[at + 2]);
    if (high >= 0 && low >= 0) return {static_cast<char>(16 * high + low), 3};
  }
  return {text[at], 1};
}

// How many bytes of `text`, escaped or not and of whichever case, agree with the longest part of
// `key` that it begins with; 0 where that is shorter than `least` characters.
std::size_t plain_part(std::string_view text, std::string_view key, std::size_t least) {
  std::size_t longest = 0;  // bytes
  std::size_t most = 0;     // characters
  for (std::size_t from = 0; from + most < key.size(); ++from) {
    std::size_t bytes = 0, count = 0;
    while (bytes < text.size() && from + count < key.size()) {
      const Character next = character_at(text, bytes);
      if (lower(next.value) != lower(key[from + count])) break;
      bytes += next.bytes;
      ++count;
    }
    if (count > most) {
      most = count;
      longest = bytes;
    }
  }
  return most >= least ? longest : 0;
}

// The key in base64, as it stands in a text of which it is a part: behind none, one or two bytes of
// something else, without the letters that say something of its neighbours.
std::array<std::string, 3> in_base64(std::string_view key) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::string, 3> all;
  for (std::size_t before = 0; before < all.size(); ++before) {
    const std::string bytes = std::string(before, '\0') + std::string(key);
    std::uint32_t bits = 0;
    unsigned count = 0;
    std::string letters;
    for (const char c : bytes) {
      bits = (bits << 8 | static_cast<unsigned char>(c)) & 0xffff;
      for (count += 8; count >= 6;) letters += kLetters[bits >> (count -= 6) & 63];
    }
    all[before] = letters.substr(before == 0 ? 0 : before + 1);
  }
  return all;
}

// A letter of base64 as URLs have it.
char of_url(char c) { return c == '+' ? '-' : c == '/' ? '_' : c; }

// How many bytes of `text` are base64 that tells of the key: of `least` characters of it.
std::size_t base64_part(std::string_view text, const std::array<std::string, 3>& forms,
                        std::size_t least) {
  std::size_t longest = 0;
  for (const std::string& form : forms) {
    for (std::size_t from = 0; from + longest < form.size(); ++from) {
      std::size_t size = 0;
      while (size < text.size() && from + size < form.size() &&
             (text[size] == form[from + size] || text[size] == of_url(form[from + size])))
        ++size;
      longest = std::max(longest, size);
    }
  }
  return longest * 6 >= least * 8 ? longest : 0;
}

// What of a key is looked for.
class Seeker {
 public:
  explicit Seeker(std::string_view key)
      : key_(key), base64_(in_base64(key)), least_(std::min(kTelling, key.size())) {
    const auto both_cases = [](char c) { return std::array{lower(c), upper(c)}; };
    for (std::size_t i = 0; i + 1 < key.size(); ++i) {
      for (const char a : both_cases(key[i])) {
        add(a, '%');
        for (const char b : both_cases(key[i + 1])) add(a, b);
      }
    }
    for (int b = 0; b < 256; ++b) add('%', static_cast<char>(b));
    for (const std::string& form : base64_) {
      for (std::size_t i = 0; i + 1 < form.size(); ++i) {
        for (const char a : {form[i], of_url(form[i])}) {
          for (const char b : {form[i + 1], of_url(form[i + 1])}) add(a, b);
        }
      }
    }
  }
  // The size of what `text` begins with; 0: nothing that tells of the key.
  std::size_t told(std::string_view text) const {
    if (least_ > 1 && (text.size() < 2 || !begins_[pair_of(text[0], text[1])])) return 0;
    return std::max(plain_part(text, key_, least_), base64_part(text, base64_, least_));
  }

 private:
  static std::size_t pair_of(char a, char b) {
    return std::size_t{static_cast<unsigned char>(a)} << 8 | static_cast<unsigned char>(b);
  }
  void add(char a, char b) { begins_.set(pair_of(a, b)); }

  std::bitset<65536> begins_;  // pairs of bytes that a part may begin with: pictures have few
  std::string_view key_;
  std::array<std::string, 3> base64_;
  std::size_t least_;
};

}  // namespace

std::string api_key() {
  const char* key = std::getenv("VLAPROBE_API_KEY");
  return key == nullptr ? "" : key;
}

Status check_api_key() {
  const std::string key = api_key();
  const bool is_text = std::ranges::all_of(
      key, [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
  if (is_text) return {};
  return Failure{Fault::kUsage, "holds a line break or another control character, which no key has",
                 "VLAPROBE_API_KEY"};
}

std::string without_key(std::string_view text, std::string_view key) {
  if (key.empty()) return std::string(text);
  const Seeker seeker(key);
  std::string clean;
  while (!text.empty()) {
    const std::size_t size = seeker.told(text);
    clean += size > 0 ? '*' : text[0];
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return clean;
}

void mask_key(std::span<std::uint8_t> bytes, std::string_view key) {
  if (key.empty()) return;
  const Seeker seeker(key);
  while (!bytes.empty()) {
    const std::size_t size =
        seeker.told({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    std::ranges::fill(bytes.first(size), std::uint8_t{'*'});
    bytes = bytes.subspan(std::max<std::size_t>(size, 1));
  }
}

std::string without_key(std::string_view text) { return without_key(text, api_key()); }

}  // namespace probe::servers
