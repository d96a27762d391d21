// The values of an attribute by name.
#pragma once

#include <optional>

#include "compiler/names/context.h"

namespace probe::sema {

// The index of the value; nothing, and P0204 with the nearest spelling, when it is none.
std::optional<std::uint32_t> find_value(Context& context, AttributeId attribute,
                                        const syntax::Name& value);

}  // namespace probe::sema
