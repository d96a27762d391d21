// The program `vlaprobe-full`: every verb. `vlaprobe` starts it when a verb needs it.
#include <cstdlib>

#include "runtime/cli/app.h"
#include "runtime/cli/full/add_all.h"

int main(int argc, char** argv) {
  unsetenv(probe::cli::kHandedOver);  // not for the programs that this one starts
  return probe::cli::run_program(argc, argv, probe::cli::add_all_verbs, true);
}
