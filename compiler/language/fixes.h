// The fixes that diagnostics offer, as edits.
#pragma once

#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"

namespace probe::language {

// Those of all diagnostics that change this file alone and do not touch each other: of two that
// overlap the first in the text.
std::vector<Replacement> all_fixes(const std::vector<const Diagnostic*>& diagnostics, FileId file);

// The text with these replacements, of which none overlaps another.
std::string applied(std::string_view text, std::vector<Replacement> replacements);

}  // namespace probe::language
