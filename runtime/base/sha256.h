// Content addresses. Everything that must not change is hashed with SHA-256 (OpenSSL's) over bytes that are written
// out here: little endian, doubles by their bit pattern.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace probe {

struct Sha256 {
  std::array<std::uint8_t, 32> bytes{};
  auto operator<=>(const Sha256&) const = default;
};

Sha256 sha256(std::span<const std::byte> data);
Sha256 sha256(std::string_view text);

// 64 lower-case hexadecimal digits.
std::string to_hex(const Sha256& hash);

// Feeds values one after the other. A string is preceded by its length, so that ("ab","c") and ("a","bc") differ.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  Hasher& bytes(std::span<const std::byte> data);
  Hasher& text(std::string_view value);
  Hasher& u8(std::uint8_t value);
  Hasher& u32(std::uint32_t value);
  Hasher& u64(std::uint64_t value);
  // The bit pattern; -0.0 is hashed as 0.0 so that equal numbers have equal hashes.
  Hasher& f64(double value);
  Hasher& f64s(std::span<const double> values);
  Hasher& hash(const Sha256& value);

  // Ends the stream; the hasher must not be used afterwards.
  Sha256 finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace probe
