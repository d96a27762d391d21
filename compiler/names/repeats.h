// Statements of one block that say the same thing twice.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// P0203 where a statement would silently replace an earlier one of its block. Statements that add
// up (`place`, `orient`, `drive`, `sun`, `seen in`, `is`, `maybe`, `seeds`) may stand repeatedly.
void check_repeats(Context& context);

}  // namespace probe::sema
