// What a run's bits depend on besides plan and assets: program, compiler, libraries, CPU. Two runs
// with equal fingerprints, plans and assets have equal traces.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"

namespace probe::store {

struct Fingerprint {
  // Name and value, ascending by name.
  std::vector<std::pair<std::string, std::string>> entries;
  bool operator==(const Fingerprint&) const = default;
};

// Of this process and machine. `assets` is asset_digest().
Fingerprint take_fingerprint(const Sha256& assets);

// Of the program or library that this code is in, hexadecimal; empty: it has none.
std::string own_build_id();

std::string to_json(const Fingerprint& fingerprint);
Result<Fingerprint> fingerprint_from_json(std::string_view text);

// "program: recorded 1f2e, here 9a7b", one line per entry that differs.
std::vector<std::string> differences(const Fingerprint& recorded, const Fingerprint& here);

}  // namespace probe::store
