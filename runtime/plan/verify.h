// The verifier: every rule of FORMAT.md, run by the compiler on its own output and by the runtime
// on every load, all of it before a byte is used. Iterative; time and memory are bounded by the
// size of the file.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/base/result.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/tables.h"

namespace probe::plan {

struct VerifyOptions {
  bool identity = true;  // stage 4, recomputing all ids; `--fast` leaves it out
};

// All four stages. A Failure has kPlan, a message that ends with the id of the rule in
// brackets, and `where` = "SECTION at byte N".
Status verify(std::span<const std::byte> bytes, const VerifyOptions& options = {});

// The stages, each of which relies on those before it. Public for tests and for readers that have
// them in hand.
Status verify_envelope(std::span<const std::byte> bytes);
Status verify_tables(std::span<const std::byte> bytes, const Tables& tables);
Status verify_code(std::span<const std::byte> bytes, const Tables& tables);
Status verify_identity(std::span<const std::byte> bytes, const Tables& tables);

// The typed views of a file whose envelope is verified. `bytes` is 8-byte aligned.
Tables view_tables(std::span<const std::byte> bytes);

}  // namespace probe::plan
