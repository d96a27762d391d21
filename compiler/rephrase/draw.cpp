#include "compiler/rephrase/draw.h"

#include "runtime/base/hash_number.h"

namespace probe::rephrase {

std::uint64_t draw(std::string_view what, std::uint64_t seed, std::string_view first,
                   std::string_view second) {
  Hasher hasher;
  hasher.text("rephrase").text(what).u64(seed).text(first).text(second);
  return big_endian_number(hasher.finish());
}

double draw_share(std::string_view what, std::uint64_t seed, std::string_view first) {
  return static_cast<double>(draw(what, seed, first) >> 11) * 0x1p-53;
}

}  // namespace probe::rephrase
