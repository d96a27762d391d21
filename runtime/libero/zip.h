// One file out of a zip archive in memory. Minizip stops here.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::libero {

// The bytes of the only member whose path ends with `ending`. How large it is the archive's
// directory says: what is larger than `most` is refused before a byte is unpacked, and what turns
// out larger than it was said to be is refused at that byte, so no archive fills the memory. Fails
// (kUsage, where = `path`) as well on no zip, no such member or several, an encrypted one, a
// checksum that is not the directory's.
Result<std::string> read_zip_member(std::span<const std::uint8_t> archive, std::string_view ending,
                                    std::size_t most, const std::string& path);
// The same where there may be none: nothing where the archive is whole and has no such member.
Result<std::optional<std::string>> find_zip_member(std::span<const std::uint8_t> archive,
                                                   std::string_view ending, std::size_t most,
                                                   const std::string& path);

}  // namespace probe::libero
