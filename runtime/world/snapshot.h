// A world's changing state as bytes, little endian, and back. What is only speed (cached faces)
// stays out.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runtime/base/sha256.h"
#include "runtime/world/stepper.h"

namespace probe::world {

std::vector<std::byte> save_state(const Stepper& stepper);
// Fails (kWorld) on bytes of another world or of no world; the stepper is then unchanged.
Status restore_state(std::span<const std::byte> bytes, Stepper* stepper);
Sha256 hash_state(const Stepper& stepper);

}  // namespace probe::world
