#include "compiler/space/draws.h"

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"

namespace probe::space {

double draw(std::uint64_t of, std::string_view what, std::uint64_t number) {
  Hasher hasher;
  hasher.text("space point").u64(of).text(what).u64(number);
  return static_cast<double>(little_endian_number(hasher.finish()) >> 11) * 0x1p-53;
}

}  // namespace probe::space
