// What rows of results may call who acted or answered.
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe {

// Fails (kUsage, at --name) on a name that a reader could take for another one: what is not one
// line of visible characters, begins or ends with a blank, or is longer than 255 bytes.
Status check_row_name(const std::string& name);

// The failure (kUsage, at --name) of a name that reads as something of the program's own, a
// "policy" or a "model"; `asked`: what the rows would be of, empty: of one of the caller's.
Failure name_taken(const std::string& name, const std::string& kind, const std::string& asked);

// Whether two names read alike: equal but for case, width of letters and what nobody sees.
bool reads_alike(std::string_view a, std::string_view b);

}  // namespace probe
