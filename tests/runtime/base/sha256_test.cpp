#include "runtime/base/sha256.h"

#include <doctest/doctest.h>

#include <algorithm>

TEST_CASE("the digest of abc is the one of FIPS 180-4") {
  CHECK(probe::to_hex(probe::sha256("abc")) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("strings are hashed with their lengths") {
  CHECK(probe::Hasher().text("ab").text("c").finish() !=
        probe::Hasher().text("a").text("bc").finish());
}

TEST_CASE("minus zero hashes as zero") {
  CHECK(probe::Hasher().f64(-0.0).finish() == probe::Hasher().f64(0.0).finish());
}

TEST_CASE("an empty message and a long one have the digests of FIPS 180-4") {
  CHECK(probe::to_hex(probe::sha256("")) ==
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  probe::Hasher hasher;
  const std::string block(1000, 'a');
  for (int i = 0; i < 1000; ++i) hasher.bytes(std::as_bytes(std::span(block)));
  CHECK(probe::to_hex(hasher.finish()) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("numbers are hashed as their little endian bytes") {
  const std::string bytes("\x01\x02\x03\x04\x05\x06\x07\x08", 8);
  CHECK(probe::Hasher().u64(0x0807060504030201u).finish() == probe::sha256(bytes));
  CHECK(probe::Hasher().u32(0x04030201u).u32(0x08070605u).finish() == probe::sha256(bytes));
}

TEST_CASE("how a message is cut into pieces does not show in its digest") {
  std::string message;
  for (int i = 0; i < 3000; ++i) message.push_back(static_cast<char>(i * 7));
  const probe::Sha256 whole = probe::sha256(message);
  const auto all = std::as_bytes(std::span(message));
  for (const std::size_t piece : {1u, 7u, 8u, 511u, 512u, 513u, 1024u, 2999u}) {
    CAPTURE(piece);
    probe::Hasher hasher;
    for (std::size_t at = 0; at < all.size(); at += piece)
      hasher.bytes(all.subspan(at, std::min(piece, all.size() - at)));
    CHECK(hasher.finish() == whole);
  }
}
