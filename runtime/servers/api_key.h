// The one secret: what is sent to a server as its key, and must get into no message and no file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::servers {

// From the environment's VLAPROBE_API_KEY; empty: none.
std::string api_key();

// Fails (kUsage) on a key with a control character, which could end a header's line.
Status check_api_key();

// `text` without the key and without any part of it of six characters or more: a text may have been
// cut in the middle of it. So are those in another case, escaped as in a URL, or in base64 (a
// shorter key whole). Each is a `*`.
std::string without_key(std::string_view text);
std::string without_key(std::string_view text, std::string_view key);

// The same of bytes that are no text, each byte becoming a `*` so that lengths stay.
void mask_key(std::span<std::uint8_t> bytes, std::string_view key);

}  // namespace probe::servers
