// What a metric can keep of a signal, made from readouts.def. Header only, because the compiler's
// parser, which knows nothing of plans, takes its words from here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/plan/format.h"
#include "runtime/plan/isa.h"

namespace probe::plan {

// Which steps decide: an earlier one alone can, or the last one has its say.
enum class Keeps : std::uint8_t { kEarlier, kLast };

struct ReadoutInfo {
  Readout readout;
  std::string_view words;  // "at end"
  Kind takes, gives;       // kBool or kReal
  Op monitor;              // what remembers; kEND: the value at the last step counts
  Keeps keeps;
  std::optional<double> never;  // the value of a condition that never held

  constexpr bool is_truth() const { return gives == Kind::kBool; }
  constexpr bool has_monitor() const { return monitor != Op::kEND; }
};

// In the order of readouts.def.
inline constexpr std::array kReadoutTable = {
#define PROBE_READOUT(id, name, words, takes, gives, monitor, keeps, never) \
  ReadoutInfo{Readout::k##name,                                             \
              words,                                                        \
              static_cast<Kind>(#takes[0]),                                 \
              static_cast<Kind>(#gives[0]),                                 \
              Op::k##monitor,                                               \
              Keeps::k##keeps,                                              \
              never},
#include "runtime/plan/readouts.def"
};

// What `ends when` is called among the metrics of a task: it stands behind no name of its own.
inline constexpr std::string_view kEndsMetric = "ended";

// Null when no read-out has this number.
constexpr const ReadoutInfo* find_readout(std::uint32_t id) {
  for (const ReadoutInfo& info : kReadoutTable) {
    if (static_cast<std::uint32_t>(info.readout) == id) return &info;
  }
  return nullptr;
}

constexpr const ReadoutInfo& info(Readout readout) {
  return *find_readout(static_cast<std::uint32_t>(readout));
}

// The read-out that this operation remembers for; null for all others.
constexpr const ReadoutInfo* readout_of(Op monitor) {
  for (const ReadoutInfo& info : kReadoutTable) {
    if (info.has_monitor() && info.monitor == monitor) return &info;
  }
  return nullptr;
}

}  // namespace probe::plan
