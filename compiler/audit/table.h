// A published table of percentages against a suite's categories: whether numbers of so few decimals
// can be averages over as many episodes as the category has.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "compiler/audit/audit.h"

namespace probe::audit {

// Adds a finding for each set of the plan that is a column of the CSV `text` (called `name`) with a
// number that is no multiple of one episode's share, to within its last decimal. Episodes are those
// of the set's tasks in the suite, under each of its seeds. Columns that are no set are named in
// `audit.unchecked`. A Failure (kTable) is a text without a column of that kind.
Status check_table(Audit& audit, const Compilation& compilation, const plan::Plan& plan,
                   std::uint32_t suite, std::string_view text, const std::string& name);

}  // namespace probe::audit
