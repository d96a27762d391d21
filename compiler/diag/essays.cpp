#include "compiler/diag/essays.h"

#include <array>

namespace probe {
namespace {

struct Essay {
  Code code;
  std::string_view text;
};
constexpr auto kEssays = std::to_array<Essay>({
#define PROBE_ESSAY(code, text) {Code::code, text},
#include "essay_table.inc"
#undef PROBE_ESSAY
});

}  // namespace

std::string_view essay(Code code) {
  for (const Essay& entry : kEssays) {
    if (entry.code == code) return entry.text;
  }
  return {};
}

}  // namespace probe
