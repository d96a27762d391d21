#include "runtime/base/row_name.h"

#include <doctest/doctest.h>

namespace probe {
namespace {

TEST_CASE("a name of rows is one line that a reader can tell from others") {
  for (const char* name : {"pi0", "pi0 part_3", "ws://10.0.0.1:8000", "mein Männchen"})
    CHECK_MESSAGE(check_row_name(name).ok(), name);
  for (const char* name : {"", " ", " pi0", "pi0 ", "pi\n0", "pi\t0",
                           "pi\xe2\x80\x8b"
                           "0",
                           "pi\xff", "\x1b[31mpi0"})
    CHECK_FALSE_MESSAGE(check_row_name(name).ok(), name);
  CHECK(check_row_name(std::string(255, 'x')).ok());
  CHECK_FALSE(check_row_name(std::string(256, 'x')).ok());
}

TEST_CASE("names read alike whatever their case, the width of their letters and what nobody sees") {
  CHECK(reads_alike("expert", "Expert"));
  CHECK(reads_alike("expert", "\xef\xbd\x85xpert"));
  CHECK(reads_alike("expert", "ex\xe2\x80\x8bpert"));
  CHECK_FALSE(reads_alike("expert", "expert 2"));
}

}  // namespace
}  // namespace probe
