// Where our own files lie on this machine.
#pragma once

#include <filesystem>

namespace probe {

// Of the program that runs. Empty when the system does not say.
std::filesystem::path folder_of_program();

// Of the program or shared library that this function is part of: of a library that somebody else's
// program has loaded, the library's. What is installed with us lies beside it. Empty when the
// system does not say.
std::filesystem::path folder_of_code();

}  // namespace probe
