// How many episodes the newest call of `run` chose for a folder: for whoever follows it. DIR/chosen.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace probe::store {

// A folder that cannot have it is followed without.
void write_chosen(const std::string& dir, std::int64_t episodes);
std::optional<std::int64_t> read_chosen(const std::string& dir);

}  // namespace probe::store
