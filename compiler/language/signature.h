// How a predicate, a relation or a measure is called.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/language/snapshot.h"

namespace probe::language {

struct Signature {
  std::string label;                                       // "near(a: object, within: length = 5cm)"
  std::vector<std::pair<std::size_t, std::size_t>> parameters;  // [begin, end) in bytes of it
  std::string documentation;
};
// Nothing for a name that is neither.
std::optional<Signature> signature_of(const Snapshot& snapshot, std::string_view callee);

struct Call {
  Signature signature;
  std::size_t parameter = 0;  // in which the place is
};
// Of the innermost call around a place.
std::optional<Call> call_at(const Snapshot& snapshot, FileId file, std::uint32_t offset);

}  // namespace probe::language
