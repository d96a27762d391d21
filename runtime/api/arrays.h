// Our containers as the interface's arrays.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>

#include "runtime/api/vlaprobe.h"

namespace probe::api {

constexpr std::int32_t type_of(const std::uint8_t*) { return VLAPROBE_U8; }
constexpr std::int32_t type_of(const std::uint16_t*) { return VLAPROBE_U16; }
constexpr std::int32_t type_of(const std::int32_t*) { return VLAPROBE_I32; }
constexpr std::int32_t type_of(const float*) { return VLAPROBE_F32; }
constexpr std::int32_t type_of(const double*) { return VLAPROBE_F64; }

template <typename T>
vlaprobe_array array_of(std::span<const T> numbers, std::initializer_list<std::size_t> shape) {
  vlaprobe_array array{};
  array.data = numbers.data();
  array.type = type_of(numbers.data());
  for (std::int64_t& side : array.shape) side = 1;
  for (const std::size_t side : shape) array.shape[array.rank++] = static_cast<std::int64_t>(side);
  return array;
}

}  // namespace probe::api
