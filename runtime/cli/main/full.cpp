// The program `vlaprobe-full`: every verb. `vlaprobe` starts it when a verb needs it.
#include "runtime/cli/full/add_all.h"

int main(int argc, char** argv) {
  return probe::cli::run_program(argc, argv, probe::cli::add_all_verbs, true);
}
