#include "runtime/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace probe {

void check_failed(const char* condition, const char* what, const char* file, int line) {
  std::fprintf(stderr, "vlaprobe: internal error: %s (%s) at %s:%d\n", what, condition, file, line);
  std::_Exit(3);
}

}  // namespace probe
