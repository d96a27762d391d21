// Numbers of the Parquet format (parquet.thrift), for its writer and its reader. Field ids stand
// where they are used. Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/export/parquet/schema.h"

namespace probe::parquet::format {

inline constexpr std::string_view kMagic = "PAR1";
// Encoding, CompressionCodec, PageType, FieldRepetitionType, ConvertedType.
inline constexpr std::int32_t kPlain = 0, kRle = 3;
inline constexpr std::int32_t kUncompressed = 0;
inline constexpr std::int32_t kDataPage = 0;
inline constexpr std::int32_t kOptional = 1, kRepeated = 2;
inline constexpr std::int32_t kUtf8 = 0, kListType = 3;

// What Type is called there.
struct Physical {
  Type type;
  std::int32_t number;
};
inline constexpr Physical kPhysical[] = {
    {Type::kFlag, 0}, {Type::kWhole, 2}, {Type::kReal32, 4}, {Type::kReal64, 5}, {Type::kText, 6}};
inline std::int32_t physical(Type type) {
  for (const Physical& known : kPhysical) {
    if (known.type == type) return known.number;
  }
  return -1;
}
inline std::optional<Type> type_of(std::int64_t number) {
  for (const Physical& known : kPhysical) {
    if (known.number == number) return known.type;
  }
  return std::nullopt;
}

// Bits that hold levels up to `most`.
inline int level_bits(int most) {
  int bits = 0;
  for (; most > 0; most >>= 1) ++bits;
  return bits;
}

}  // namespace probe::parquet::format
