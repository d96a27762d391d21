#include "runtime/servers/api_key.h"

#include <algorithm>
#include <cstdlib>

namespace probe::servers {
namespace {

// A shorter part says little of a key and is found in other words too.
constexpr std::size_t kTelling = 6;

// How far `text` and some part of `key` agree from their beginnings.
std::size_t common_part(std::string_view text, std::string_view key) {
  std::size_t longest = 0;
  for (std::size_t from = 0; from + longest < key.size(); ++from) {
    const std::string_view part = key.substr(from);
    const auto end = std::ranges::mismatch(text, part).in1;
    longest = std::max(longest, static_cast<std::size_t>(end - text.begin()));
  }
  return longest;
}

// The size of the part of `key` that `text` begins with; 0: none that tells of it.
std::size_t telling_part(std::string_view text, std::string_view key) {
  const std::size_t size = common_part(text, key);
  return size >= std::min(kTelling, key.size()) ? size : 0;
}

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
  std::string clean;
  while (!text.empty()) {
    const std::size_t size = telling_part(text, key);
    clean += size > 0 ? '*' : text[0];
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return clean;
}

void mask_key(std::span<std::uint8_t> bytes, std::string_view key) {
  if (key.empty()) return;
  while (!bytes.empty()) {
    const std::size_t size =
        telling_part({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, key);
    std::ranges::fill(bytes.first(size), std::uint8_t{'*'});
    bytes = bytes.subspan(std::max<std::size_t>(size, 1));
  }
}

std::string without_key(std::string_view text) { return without_key(text, api_key()); }

}  // namespace probe::servers
