#include "runtime/base/sha256.h"

#include <doctest/doctest.h>

TEST_CASE("the digest of abc is the one of FIPS 180-4") {
  CHECK(probe::to_hex(probe::sha256("abc")) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("strings are hashed with their lengths") {
  CHECK(probe::Hasher().text("ab").text("c").finish() != probe::Hasher().text("a").text("bc").finish());
}

TEST_CASE("minus zero hashes as zero") {
  CHECK(probe::Hasher().f64(-0.0).finish() == probe::Hasher().f64(0.0).finish());
}
