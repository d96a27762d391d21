// Our own mistakes. Checks stay on in release: a wrong number in a paper costs more than a compare.
#pragma once

namespace probe {

// Prints what the reader should know with the place, and ends the process with exit code 3.
[[noreturn]] void check_failed(const char* condition, const char* what, const char* file, int line);

}  // namespace probe

#define PROBE_CHECK(condition, what)                                                        \
  do {                                                                                      \
    if (!(condition)) ::probe::check_failed(#condition, (what), __FILE__, __LINE__);        \
  } while (false)
