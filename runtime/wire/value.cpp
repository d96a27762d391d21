#include "runtime/wire/value.h"

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "runtime/base/printable.h"

namespace probe::wire {
namespace {

constexpr std::size_t kShown = 60;  // characters of a text that a message repeats

std::string joined(const std::vector<std::int64_t>& shape) {
  std::string text;
  for (const std::int64_t n : shape) {
    if (text.size() > kShown) return text + " x ...";
    text += (text.empty() ? "" : " x ") + std::to_string(n);
  }
  return text.empty() ? "scalar" : text;
}

std::string shown(std::string_view text) { return printable(text, kShown); }

template <typename T>
double load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

double load_half(const std::uint8_t* at) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, at, sizeof bits);
  return static_cast<double>(Eigen::numext::bit_cast<Eigen::half>(bits));
}

struct Reader {
  std::string_view dtype;
  std::size_t size;
  double (*load)(const std::uint8_t*);
};

// Hosts are little-endian, as the wire is.
static_assert(std::endian::native == std::endian::little);
constexpr Reader kReaders[] = {
    {"|u1", 1, &load<std::uint8_t>},  {"|i1", 1, &load<std::int8_t>},
    {"|b1", 1, &load<std::uint8_t>},  {"<i2", 2, &load<std::int16_t>},
    {"<u2", 2, &load<std::uint16_t>}, {"<i4", 4, &load<std::int32_t>},
    {"<u4", 4, &load<std::uint32_t>}, {"<i8", 8, &load<std::int64_t>},
    {"<f2", 2, &load_half},           {"<f4", 4, &load<float>},
    {"<f8", 8, &load<double>},
};

const Reader* reader_of(std::string_view dtype) {
  for (const Reader& reader : kReaders) {
    if (reader.dtype == dtype) return &reader;
  }
  return nullptr;
}

Status append_numbers(const Value& value, std::vector<double>* numbers) {
  if (const auto* d = value.as<double>()) {
    numbers->push_back(*d);
    return {};
  }
  if (const auto* i = value.as<std::int64_t>()) {
    numbers->push_back(static_cast<double>(*i));
    return {};
  }
  if (const auto* list = value.as<List>()) {
    for (const Value& element : *list) PROBE_TRY(append_numbers(element, numbers));
    return {};
  }
  const auto* array = value.as<Array>();
  if (array == nullptr)
    return Failure{Fault::kPolicy, "expected numbers, got " + describe(value), ""};
  PROBE_TRY(check_fit(*array));
  const Reader& reader = *reader_of(array->dtype);
  const std::size_t count = array->bytes.size() / reader.size;
  for (std::size_t i = 0; i < count; ++i) {
    numbers->push_back(reader.load(array->bytes.data() + i * reader.size));
  }
  return {};
}

template <typename T>
Array array_of(std::string dtype, std::vector<std::int64_t> shape,
               const std::vector<double>& values) {
  Array array{std::move(dtype), std::move(shape), Bytes(values.size() * sizeof(T))};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = static_cast<T>(values[i]);
    std::memcpy(array.bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return array;
}

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto* map = as<Map>();
  if (map == nullptr) return nullptr;
  for (const auto& [name, value] : *map) {
    if (name == key) return &value;
  }
  return nullptr;
}

std::string describe(const Value& value) {
  if (value.as<bool>() != nullptr) return *value.as<bool>() ? "true" : "false";
  if (const auto* i = value.as<std::int64_t>()) return "the number " + std::to_string(*i);
  if (const auto* d = value.as<double>()) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", *d);
    return std::string("the number ") + digits;
  }
  if (const auto* s = value.as<std::string>()) return "the text \"" + shown(*s) + "\"";
  if (const auto* b = value.as<Bytes>()) return std::to_string(b->size()) + " bytes";
  if (const auto* a = value.as<Array>()) {
    return "an array " + joined(a->shape) + " of " + shown(a->dtype);
  }
  if (const auto* list = value.as<List>()) return "a list of " + std::to_string(list->size());
  if (const auto* map = value.as<Map>()) {
    std::string keys;
    for (const auto& [name, unused] : *map) {
      if (keys.size() > kShown) return "a map with keys " + keys + ", ...";
      keys += (keys.empty() ? "" : ", ") + shown(name);
    }
    return map->empty() ? "an empty map" : "a map with keys " + keys;
  }
  return "nil";
}

Array array_u8(std::vector<std::int64_t> shape, Bytes bytes) {
  return {"|u1", std::move(shape), std::move(bytes)};
}
Array array_f32(std::vector<std::int64_t> shape, const std::vector<double>& values) {
  return array_of<float>("<f4", std::move(shape), values);
}
Array array_f64(std::vector<std::int64_t> shape, const std::vector<double>& values) {
  return array_of<double>("<f8", std::move(shape), values);
}

Status check_fit(const Array& array) {
  const Reader* reader = reader_of(array.dtype);
  if (reader == nullptr) {
    return Failure{Fault::kPolicy, "an array of dtype `" + shown(array.dtype) + "` is not read",
                   ""};
  }
  // A product that passes the number of bytes need not be followed further.
  std::uint64_t count = 1;
  for (const std::int64_t n : array.shape) {
    count = n < 0 ? array.bytes.size() + 1 : count * static_cast<std::uint64_t>(n);
    if (count > array.bytes.size()) break;
  }
  if (count * reader->size == array.bytes.size()) return {};
  return Failure{Fault::kPolicy,
                 "an array of shape " + joined(array.shape) + " and dtype " + array.dtype +
                     " has " + std::to_string(array.bytes.size()) + " bytes",
                 ""};
}

Result<std::vector<double>> to_numbers(const Value& value) {
  std::vector<double> numbers;
  PROBE_TRY(append_numbers(value, &numbers));
  return numbers;
}

std::vector<std::int64_t> shape_of(const Value& value) {
  if (const auto* array = value.as<Array>()) return array->shape;
  std::vector<std::int64_t> shape;
  const Value* at = &value;
  while (const auto* list = at->as<List>()) {
    shape.push_back(static_cast<std::int64_t>(list->size()));
    if (list->empty()) break;
    at = &list->front();
  }
  if (const auto* array = at->as<Array>()) {
    shape.insert(shape.end(), array->shape.begin(), array->shape.end());
  }
  return shape;
}

}  // namespace probe::wire
