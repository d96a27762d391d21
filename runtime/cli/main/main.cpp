// The program `vlaprobe`.
#include "runtime/cli/verbs.h"

int main(int argc, char** argv) { return probe::cli::main(argc, argv); }
