// The payloads of a trace's chunks: records to bytes and back. Private to the trace reader and
// writer.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/bytes.h"
#include "runtime/store/trace.h"

namespace probe::store::codec {

inline constexpr std::uint32_t kVersion = 1;
// Of live episodes one more; where actions are an arm's joints' two more.
inline constexpr std::uint32_t kOfLive = 1, kOfJoints = 2;
inline constexpr std::uint32_t kLastVersion = kVersion + kOfLive + kOfJoints;
inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'T', 'R', 'C', '\r', '\n', 0x1a, '\n'};

// Four letters each, as they stand in the file.
enum class Tag : std::uint32_t {
  kHead = 0x44414548,         // HEAD
  kActions = 0x4e544341,      // ACTN, of versions 3 and 4
  kLater = 0x4e454854,        // THEN, of a task whose instruction changes
  kLive = 0x4556494c,         // LIVE, of versions 2 and 4
  kFingerprint = 0x474e4946,  // FING, not hashed
  kSettled = 0x4c544553,      // SETL
  kOwn = 0x534e574f,          // OWNS, of what moves by itself
  kStep = 0x50455453,         // STEP
  kTime = 0x454d4954,         // TIME, not hashed
  kDone = 0x454e4f44,         // DONE
  kHash = 0x48534148,         // HASH, not hashed
};

inline bool is_hashed(Tag tag) {
  return tag == Tag::kHead || tag == Tag::kActions || tag == Tag::kLater || tag == Tag::kLive ||
         tag == Tag::kSettled || tag == Tag::kOwn || tag == Tag::kStep || tag == Tag::kDone;
}

void put_header(ByteWriter& to, const TraceHeader& header);
void put_actions(ByteWriter& to, const TraceHeader::JointActions& actions);
void put_later(ByteWriter& to, const std::vector<std::string>& later);
void put_terms(ByteWriter& to, const policy::LiveTerms& terms);
void put_start(ByteWriter& to, const TraceStart& start);
void put_own(ByteWriter& to, const TraceStep& step);
void put_step(ByteWriter& to, const TraceStep& step);
void put_end(ByteWriter& to, const TraceEnd& end);

// Nothing if the bytes do not have the form of the record, all of them.
std::optional<TraceHeader> get_header(std::span<const std::byte> bytes);
std::optional<TraceHeader::JointActions> get_actions(std::span<const std::byte> bytes);
std::optional<std::vector<std::string>> get_later(std::span<const std::byte> bytes);
std::optional<policy::LiveTerms> get_terms(std::span<const std::byte> bytes);
std::optional<TraceStart> get_start(std::span<const std::byte> bytes);
std::optional<std::vector<vm::OwnPlace>> get_own(std::span<const std::byte> bytes);
// `is_live`: of versions 2 and 4; an action has `numbers`. Without the places of what moves by
// itself.
std::optional<TraceStep> get_step(std::span<const std::byte> bytes, bool is_live,
                                  std::size_t numbers);
std::optional<TraceEnd> get_end(std::span<const std::byte> bytes);

}  // namespace probe::store::codec
