// What goes over a wire: a tree of numbers, texts, bytes and arrays. Knows no protocol.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "runtime/base/result.h"

namespace probe::wire {

// Of one message: the numbers, texts, lists and maps that are read, and the dimensions of an array. A
// value takes a hundred times the byte it may have in a message; pictures and actions are arrays,
// which count once.
inline constexpr std::size_t kMostValues = std::size_t{1} << 20;
inline constexpr std::size_t kMostDimensions = 32;

// An n-dimensional array as numpy holds it in C order.
struct Array {
  std::string dtype;  // numpy's dtype.str: "|u1", "<f4", "<f8", "<i4", "<i8", "|b1"
  std::vector<std::int64_t> shape;
  std::vector<std::uint8_t> bytes;
  bool operator==(const Array&) const = default;
};

class Value;
using Bytes = std::vector<std::uint8_t>;
using List = std::vector<Value>;
// In the order of the message, which is ours to keep when we write and of no meaning when we read.
using Map = std::vector<std::pair<std::string, Value>>;

class Value {
 public:
  using Kind = std::variant<std::monostate, bool, std::int64_t, double, std::string, Bytes, Array,
                            List, Map>;

  Value() = default;
  Value(bool value) : kind_(value) {}
  Value(int value) : kind_(static_cast<std::int64_t>(value)) {}
  Value(std::int64_t value) : kind_(value) {}
  Value(double value) : kind_(value) {}
  Value(const char* value) : kind_(std::string(value)) {}
  Value(std::string value) : kind_(std::move(value)) {}
  Value(Bytes value) : kind_(std::move(value)) {}
  Value(Array value) : kind_(std::move(value)) {}
  Value(List value) : kind_(std::move(value)) {}
  Value(Map value) : kind_(std::move(value)) {}

  template <typename T>
  const T* as() const {
    return std::get_if<T>(&kind_);
  }
  const Kind& kind() const { return kind_; }

  // The entry of a map, or nothing where this is no map or has no such key.
  const Value* find(std::string_view key) const;

  bool operator==(const Value&) const = default;

 private:
  Kind kind_;
};

// "map with keys actions, state", "f8 array 4 x 7", "text \"...\"": what a message about an
// unexpected answer shows. At most about a hundred characters, whatever the value.
std::string describe(const Value& value);

// An array of bytes or floats made in place.
Array array_u8(std::vector<std::int64_t> shape, Bytes bytes);
Array array_f32(std::vector<std::int64_t> shape, const std::vector<double>& values);
Array array_f64(std::vector<std::int64_t> shape, const std::vector<double>& values);

// Fails (kPolicy) unless the bytes are what shape and dtype need.
Status check_fit(const Array& array);

// The elements as numbers. Also of a plain number, a list of numbers, nested lists. Fails
// (kPolicy) on anything else or when bytes do not fit the shape.
Result<std::vector<double>> to_numbers(const Value& value);
// The shape of what to_numbers reads; empty for a plain number.
std::vector<std::int64_t> shape_of(const Value& value);

}  // namespace probe::wire
