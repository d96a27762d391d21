// Thrift's compact protocol: numbers as zigzag varints, fields by the distance of their ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace probe::parquet::thrift {

// What stands before a value in the bytes.
enum class Kind : std::uint8_t {
  kTrue = 1,
  kFalse = 2,
  kByte = 3,
  kI16 = 4,
  kI32 = 5,
  kI64 = 6,
  kDouble = 7,
  kBinary = 8,
  kList = 9,
  kStruct = 12,
};

// Writes one struct; those inside it are written by the same object between begin() and end().
class Writer {
 public:
  Writer& i16(int id, std::int16_t value);
  Writer& i32(int id, std::int32_t value);
  Writer& i64(int id, std::int64_t value);
  Writer& flag(int id, bool value);
  Writer& byte(int id, std::int8_t value);
  Writer& text(int id, std::string_view value);
  Writer& begin(int id);  // a struct
  // A list, whose elements follow: element_i32, element_text, or element() ... end() each.
  Writer& list(int id, Kind of, std::size_t count);
  Writer& element_i32(std::int32_t value);
  Writer& element_text(std::string_view value);
  Writer& element();  // a struct in a list
  Writer& end();      // of the struct that was begun last; once more than begun, the outermost
  // Bytes of whole elements that were written elsewhere.
  Writer& raw(std::string_view bytes);

  const std::string& bytes() const { return bytes_; }

 private:
  void field(int id, Kind kind);
  void varint(std::uint64_t value);
  void zigzag(std::int64_t value);
  std::string bytes_;
  std::vector<int> ids_ = {0};  // the last field's, of each struct that is open
};

// A struct as it was read: whatever has no name for the reader is carried along.
struct Value {
  int field = 0;  // the id, of a field
  Kind kind = Kind::kStruct;
  std::int64_t whole = 0;       // numbers and truths
  std::string bytes;            // of kBinary
  std::vector<Value> fields;    // of kStruct
  std::vector<Value> elements;  // of kList

  const Value* find(int id) const;
  std::optional<std::int64_t> whole_at(int id) const;
  const std::string* bytes_at(int id) const;
  const Value* list_at(int id) const;
  const Value* struct_at(int id) const;
};

// One struct from the beginning of `bytes`, and how many they are; nothing if they hold none, or
// one of unreasonable depth.
struct Read {
  Value value;
  std::size_t size = 0;
};
std::optional<Read> read_struct(std::span<const std::uint8_t> bytes);

}  // namespace probe::parquet::thrift
