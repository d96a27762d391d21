// Every verb there is.
#pragma once

#include "runtime/cli/app.h"

namespace probe::cli {

void add_all_verbs(Verb program, int& exit);

}  // namespace probe::cli
