#include "runtime/policy/sent_prompt.h"

#include <doctest/doctest.h>

#include "runtime/base/sha256.h"

namespace probe::policy {

TEST_CASE("an instruction is sent as some profile writes it, and as nothing else") {
  const auto can_be = [](std::string_view sent) {
    return can_be_sent_as("Put the Carrot down", to_hex(sha256(sent)));
  };
  CHECK(can_be("Put the Carrot down"));
  CHECK(can_be("Put the Carrot down."));
  CHECK(can_be("put the carrot down"));
  CHECK(can_be("put the carrot down."));
  CHECK(!can_be("put the plate down"));
  CHECK(!can_be("PUT THE CARROT DOWN"));
  CHECK(!can_be("Put the Carrot down.."));
  CHECK(!can_be(""));
  CHECK(!can_be_sent_as("Put the Carrot down", ""));
  CHECK(can_be_sent_as("Put it down.", to_hex(sha256(std::string_view("Put it down")))));
}

}  // namespace probe::policy
