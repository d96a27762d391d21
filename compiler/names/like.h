// In which order records that copy one another are read.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// The order in which records that copy one another can be filled: a parent before its children. A
// circle is P0207 and its members lose their parent. `parents[i]` is an index or nothing; `names`
// and `spans` are for the message.
std::vector<std::uint32_t> parents_first(Context& context,
                                         std::vector<std::optional<std::uint32_t>>& parents,
                                         const std::vector<syntax::Name>& names);

}  // namespace probe::sema
