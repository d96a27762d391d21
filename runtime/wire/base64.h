// Bytes as text (RFC 4648, section 4, with padding).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace probe::wire {

std::string to_base64(std::span<const std::uint8_t> bytes);

// Nothing on a length that is no multiple of four, on other letters and on padding elsewhere than
// at the end.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace probe::wire
