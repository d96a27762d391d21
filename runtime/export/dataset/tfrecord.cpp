#include "runtime/export/dataset/tfrecord.h"

#include <array>
#include <cstring>
#include <utility>

namespace probe::dataset {
namespace {

constexpr std::uint32_t kCastagnoli = 0x82f63b78;  // reflected
constexpr std::uint32_t kMaskDelta = 0xa282ead8;

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ (value & 1 ? kCastagnoli : 0);
    table[i] = value;
  }
  return table;
}();

// Protocol buffers: a field's number and how it is laid out, then its value.
enum class Wire : std::uint8_t { kVarint = 0, kLength = 2 };

void put_varint(std::string& to, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) to.push_back(static_cast<char>((value & 0x7f) | 0x80));
  to.push_back(static_cast<char>(value));
}

void put_field(std::string& to, int number, std::string_view bytes) {
  put_varint(to,
             static_cast<std::uint64_t>(number) << 3 | static_cast<std::uint64_t>(Wire::kLength));
  put_varint(to, bytes.size());
  to.append(bytes);
}

// Feature's oneof.
constexpr int kBytesList = 1, kFloatList = 2, kInt64List = 3;

template <typename T>
std::string as_bytes(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

}  // namespace

std::uint32_t crc32c(std::string_view bytes) {
  std::uint32_t value = 0xffffffff;
  for (const char c : bytes)
    value = kCrcTable[(value ^ static_cast<std::uint8_t>(c)) & 0xff] ^ value >> 8;
  return value ^ 0xffffffff;
}

std::uint32_t masked_crc32c(std::string_view bytes) {
  const std::uint32_t crc = crc32c(bytes);
  return (crc >> 15 | crc << 17) + kMaskDelta;
}

void ExampleMessage::bytes(const std::string& key, std::span<const std::string> values) {
  std::string list;
  for (const std::string& value : values) put_field(list, 1, value);
  put_field(features_[key], kBytesList, list);
}

void ExampleMessage::reals(const std::string& key, std::span<const float> values) {
  std::string packed(values.size_bytes(), '\0');
  if (!values.empty()) std::memcpy(packed.data(), values.data(), values.size_bytes());
  std::string list;
  put_field(list, 1, packed);
  put_field(features_[key], kFloatList, list);
}

void ExampleMessage::wholes(const std::string& key, std::span<const std::int64_t> values) {
  std::string packed, list;
  for (const std::int64_t value : values) put_varint(packed, static_cast<std::uint64_t>(value));
  put_field(list, 1, packed);
  put_field(features_[key], kInt64List, list);
}

std::string ExampleMessage::finish() const {
  std::string map, message;
  for (const auto& [key, feature] : features_) {
    std::string entry;
    put_field(entry, 1, key);
    put_field(entry, 2, feature);
    put_field(map, 1, entry);
  }
  put_field(message, 1, map);
  return message;
}

Result<std::unique_ptr<RecordFile>> RecordFile::create(const std::string& path) {
  PROBE_ASSIGN(FileStream file, FileStream::create(path));
  return std::unique_ptr<RecordFile>(new RecordFile(std::move(file)));
}

Status RecordFile::add(std::string_view payload) {
  const std::string size = as_bytes(static_cast<std::uint64_t>(payload.size()));
  PROBE_TRY(file_.write(size + as_bytes(masked_crc32c(size))));
  PROBE_TRY(file_.write(payload));
  return file_.write(as_bytes(masked_crc32c(payload)));
}

}  // namespace probe::dataset
