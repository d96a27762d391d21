// What names stand for: the one table of kinds.def.
#pragma once

#include <cstdint>
#include <string_view>

namespace probe::language {

enum class Kind : std::uint8_t {
#define PROBE_KIND(name, word, symbol, item, token) k##name,
#include "compiler/language/kinds.def"
};

struct KindInfo {
  std::string_view word;
  int symbol = 0, item = 0;
  std::string_view token;
};

inline constexpr KindInfo kKinds[] = {
#define PROBE_KIND(name, word, symbol, item, token) {word, symbol, item, token},
#include "compiler/language/kinds.def"
};
inline constexpr std::size_t kKindCount = sizeof kKinds / sizeof kKinds[0];

constexpr const KindInfo& info(Kind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

// Several of them; of what it has declarations the first counts.
class Kinds {
 public:
  constexpr Kinds() = default;
  constexpr Kinds(Kind kind) : bits_(1u << static_cast<unsigned>(kind)) {}
  constexpr bool has(Kind kind) const { return (bits_ & Kinds(kind).bits_) != 0; }
  constexpr bool is_none() const { return bits_ == 0; }
  friend constexpr Kinds operator|(Kinds a, Kinds b) {
    Kinds both;
    both.bits_ = a.bits_ | b.bits_;
    return both;
  }

 private:
  std::uint32_t bits_ = 0;
};
constexpr Kinds operator|(Kind a, Kind b) { return Kinds(a) | Kinds(b); }
static_assert(kKindCount <= 32);

}  // namespace probe::language
