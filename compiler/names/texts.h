// Texts and names that go into a plan as they are: what its verifier would refuse is said here,
// where it is written.
#pragma once

#include <string>
#include <string_view>

#include "compiler/diag/diagnostic.h"
#include "compiler/names/symbols.h"

namespace probe::sema {

// What is wrong with a text that people and policies read, beside its length: "holds the invisible
// character U+200B". Empty when nothing is.
std::string defect_of(std::string_view text);
// P0304 for a text with a defect or longer than a plan keeps. `what`: "the name of an object".
void check_text(Diagnostics& diagnostics, const Spelled& text, std::string_view what);
// P0304 for a name that is longer than a plan keeps.
void check_name(Diagnostics& diagnostics, const syntax::Name& name);

}  // namespace probe::sema
