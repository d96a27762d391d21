#include "runtime/base/hash_number.h"

#include <doctest/doctest.h>

using namespace probe;

TEST_CASE("numbers of a hash are its bytes, eight at a time, in either order") {
  Sha256 hash;
  for (std::size_t i = 0; i < hash.bytes.size(); ++i)
    hash.bytes[i] = static_cast<std::uint8_t>(i + 1);
  CHECK(big_endian_number(hash) == 0x0102030405060708u);
  CHECK(little_endian_number(hash) == 0x0807060504030201u);
  CHECK(big_endian_number(hash, kNumbersOfHash - 1) == 0x191a1b1c1d1e1f20u);
  CHECK(little_endian_number(hash, kNumbersOfHash - 1) == 0x201f1e1d1c1b1a19u);
}
