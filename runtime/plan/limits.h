// How much of anything a plan may hold: one number each, for the compiler, which names the place in
// the text, and for the verifier, which names the record. They bound the work per record.
#pragma once

#include <cstddef>
#include <cstdint>

namespace probe::plan {

inline constexpr std::size_t kMaxInstructions = 4096;  // of a program
inline constexpr std::size_t kMaxBodies = 256;         // of a task
inline constexpr std::size_t kMaxMetrics = 256;        // of a task
inline constexpr std::size_t kMaxConstants = 65536;    // of a program
inline constexpr std::size_t kMaxDrives = 64;          // of a robot
inline constexpr std::size_t kMaxFingers = 8;          // of a robot
inline constexpr std::size_t kMaxMeshes = 256;         // that a robot's description names
inline constexpr std::size_t kMaxSuns = 64;            // of a light; lamps, too
inline constexpr std::size_t kMaxStringBytes = 4096;
inline constexpr std::size_t kMaxNameBytes = 255;      // of a declaration, which names files
inline constexpr std::uint32_t kMaxPixels = 8192;      // a side of an image
inline constexpr std::uint32_t kMaxHorizon = 100'000;  // control steps: over 5 hours at 5 Hz
inline constexpr std::uint32_t kMaxIdle = 1000;        // control steps before the first
inline constexpr std::uint32_t kMaxDelay = 1000;       // control steps until an action acts
inline constexpr std::size_t kMaxLegs = 64;            // of the way of an object
inline constexpr double kMinMoveSpeed = 1e-4, kMaxMoveSpeed = 10;  // m/s, of an object by itself
inline constexpr double kMinLeg = 1e-4;                            // m
inline constexpr double kMinScale = 0.01, kMaxScale = 100;         // of an object's mesh
inline constexpr double kMaxBlur = 64;                             // pixels
inline constexpr double kMaxExposure = 1000;
inline constexpr double kMaxSubsteps = 100'000;  // physics steps in a control step
inline constexpr std::size_t kMaxOptions = 26;   // of a choice: one letter each
inline constexpr double kMaxSettle = 60;         // s

}  // namespace probe::plan
