// Where our own files lie on this machine.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace probe {

// Of the program that runs: where `vlaprobe` and `vlaprobe-full` are called from. In an unpacked bundle the loader
// in its `lib` is what the kernel sees, and the folder is the `bin` beside that. Empty when the system does not say.
std::filesystem::path folder_of_program();

// Of the program or shared library that this function is part of: of a library that somebody else's
// program has loaded, the library's. What is installed with us lies beside it. Empty when the
// system does not say.
std::filesystem::path folder_of_code();

// Where `what` of ours ("assets", "dsl", "tests/golden_frames") may lie, best first: beside the folder of this code,
// then in the source tree that it was built from; a bundle has none.
std::vector<std::filesystem::path> own_places(std::string_view what);

}  // namespace probe
