// Little-endian bytes, written and read back with bounds checks: the alphabet of the trace format.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/sha256.h"

namespace probe {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

class ByteWriter {
 public:
  void u8(std::uint8_t value) { put(&value, sizeof value); }
  void u16(std::uint16_t value) { put(&value, sizeof value); }
  void u32(std::uint32_t value) { put(&value, sizeof value); }
  void u64(std::uint64_t value) { put(&value, sizeof value); }
  void f64(double value) { put(&value, sizeof value); }
  void vec(const Vec3& value) { put(value.data(), 3 * sizeof(double)); }
  void quat(const Quat& q) {
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) f64(value);
  }
  void hash(const Sha256& value) { put(value.bytes.data(), value.bytes.size()); }
  void text(std::string_view value) {
    u32(static_cast<std::uint32_t>(value.size()));
    put(value.data(), value.size());
  }
  void reals(std::span<const double> values) {
    u32(static_cast<std::uint32_t>(values.size()));
    put(values.data(), values.size_bytes());
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  void put(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }
  std::vector<std::byte> bytes_;
};

// After a read past the end every further read gives zero and ok() is false: check once, after the
// last field.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return get<std::uint8_t>(); }
  std::uint16_t u16() { return get<std::uint16_t>(); }
  std::uint32_t u32() { return get<std::uint32_t>(); }
  std::uint64_t u64() { return get<std::uint64_t>(); }
  double f64() { return get<double>(); }
  Vec3 vec() {
    const double x = f64(), y = f64(), z = f64();
    return {x, y, z};
  }
  Quat quat() {
    const double w = f64(), x = f64(), y = f64(), z = f64();
    return {w, x, y, z};
  }
  Sha256 hash() {
    Sha256 value;
    const auto from = take(value.bytes.size());
    if (ok_) std::memcpy(value.bytes.data(), from.data(), from.size());
    return value;
  }
  std::string text() {
    const auto from = take(u32());
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  std::vector<double> reals() {
    const std::size_t count = u32();
    const auto from = take(count * sizeof(double));
    std::vector<double> values(from.size() / sizeof(double));
    if (!from.empty()) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }
  // A count of things that take at least `least` bytes each: never larger than what is left allows.
  std::size_t count(std::size_t value, std::size_t least) {
    if (value <= left() / least) return value;
    ok_ = false;
    return 0;
  }
  std::span<const std::byte> take(std::size_t size) {
    if (!ok_ || size > left()) {
      ok_ = false;
      return {};
    }
    const auto part = bytes_.subspan(at_, size);
    at_ += size;
    return part;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }
  bool ok() const { return ok_; }

 private:
  template <typename T>
  T get() {
    T value{};
    const auto from = take(sizeof value);
    if (ok_) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace probe
