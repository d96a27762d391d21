// All that changes while an episode goes on, as data and as bytes that another process can go on
// from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/stage/episode_world.h"
#include "runtime/vm/judge.h"
#include "runtime/vm/told.h"

namespace probe::stage {

// Where things were at a step before.
struct PastPlaces {
  int step = 0;
  std::vector<double> q;
  std::vector<Pose> objects;
};

// Of no meaning to a stage of another plan or task.
struct StageState {
  std::uint32_t start = 0;  // within the task
  Sha256 episode_id;        // of that start, by the plan
  WorldState world;         // bodies, joints, contacts, the controller's target, steps done
  vm::JudgeState judge;     // monitors and verdicts so far
  std::optional<vm::ToldState> told = {};  // of a task whose instruction changes
  std::vector<PastPlaces> past = {};  // where a camera may show them late; at most 33

  // Little endian: "\x89STG\r\n\x1a\n", u32 version 1, 2 where actions are late or pictures
  // dropped, 3 where late ones are not of a tool's seven numbers, 4 where the instruction changes;
  // start, episode id; world: steps, controller (target pose, joint targets, u8 reached), bodies at
  // the start, physics; judge: monitors, values, u8 decided; from version 2 on actions on their way
  // (from 3 on with a u32 count each) and past places; of 4 u32 sentence, u32 count of conditions,
  // each as a judge; the first 8 bytes of the SHA-256 of all before. The physics has its own
  // magic and counts (world/snapshot). Equal states have equal bytes.
  std::vector<std::byte> to_bytes() const;
  // Fails (kWorld) on bytes that are no saved stage, of another version, cut short, changed or
  // longer than any stage needs; never takes more memory than a few times the bytes. Whether the
  // state is this task's is Stage::restore()'s to say.
  static Result<StageState> from_bytes(std::span<const std::byte> bytes);
};

}  // namespace probe::stage
