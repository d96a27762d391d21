// The content ids: what makes two starts, prompts, judges and episodes the same. SHA-256 over the
// canonical encodings of FORMAT.md; names of declarations, their order and source positions are
// never hashed. The compiler computes them, the verifier recomputes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/sha256.h"
#include "runtime/plan/tables.h"

namespace probe::plan {

// The root of a plan: version and the directory entries that are not ignorable, without their
// offsets.
Sha256 root_hash(const Header& header, std::span<const DirectoryEntry> directory);

Sha256 prompt_id(std::string_view prompt);
// Of a task: with its later sentences and what brings them, where it has any. Program hashes are
// taken from `tables`.
Sha256 prompt_id(const Tables& tables, std::uint32_t task);
// Constants, states, code, and each metric's type, readout and name: what is judged and how it is
// called.
Sha256 program_hash(const Tables& tables, const ProgramRecord& program);
Sha256 episode_id(const Sha256& start, const Sha256& prompt, const Sha256& judge);

inline Sha256 to_sha256(const std::array<std::uint8_t, 32>& bytes) { return Sha256{bytes}; }

// What is asked and what is right: form, moment, pixels, text, options with their words, truth. Not
// the names of the family and of the task; at an episode's end the task's instruction and judge,
// too. Options and the task's judge id are taken from `tables`.
Sha256 question_id(const Tables& tables, const QuestionRecord& question);

// Ids of one set of tables. Remembers the hashes of programs, stages and objects, so that a million
// episodes cost one short hash each. The tables are verified (or written by
// Writer) and their owner outlives it.
class IdHasher {
 public:
  explicit IdHasher(const Tables& tables);

  // Program hash, horizon, control law and its rate.
  Sha256 judge(const TaskRecord& task);
  // Everything physical and visible before the first action: scene, robot, assets by content,
  // objects, placements in their order (source, target, distractors), drop, settle, camera, light.
  Sha256 start(const TaskRecord& task, const EpisodeRecord& episode);
  Sha256 episode(const TaskRecord& task, const EpisodeRecord& episode);

  // What a start id is made of, for saying which part of two starts differs: the robot, the rest of
  // the scene, camera, light, drop, then for each placed object what it is and where it lies.
  struct StartPart {
    std::string name;
    Sha256 hash;
    bool operator==(const StartPart&) const = default;
  };
  std::vector<StartPart> start_parts(const TaskRecord& task, const EpisodeRecord& episode);
  // A scene but for its robot and textures, its surface put at `surface_z` with all that stands on
  // it.
  Sha256 surroundings_at(const SceneRecord& scene, double surface_z) const;

 private:
  Sha256 program(std::uint32_t index);
  Sha256 object(std::uint32_t index);
  Sha256 scene(std::uint32_t index);
  void hash_surroundings(Hasher& hasher, const SceneRecord& scene) const;
  void hash_covers(Hasher& hasher, const Slice& covers) const;
  void hash_law(Hasher& hasher, const LawRecord& law) const;
  void hash_idle(Hasher& hasher, const TaskRecord& task) const;
  void hash_moves(Hasher& hasher, const TaskRecord& task) const;
  Sha256 robot(const RobotRecord& robot) const;
  Sha256 fixture(const FixtureRecord& fixture) const;
  Sha256 camera(std::uint32_t index);
  void hash_lens(Hasher& hasher, const CameraRecord& camera) const;
  Sha256 lenses(const TaskRecord& task);                        // all cameras but for their sensors
  std::optional<Sha256> sensors(const TaskRecord& task) const;  // none where no camera has one
  Sha256 cameras(const TaskRecord& task);                       // all of them
  Sha256 light(std::uint32_t index);
  Sha256 asset(std::uint32_t index) const;
  Sha256 prompt(std::uint32_t task);

  Tables tables_;
  std::vector<std::optional<Sha256>> programs_, objects_, scenes_, cameras_, lights_;
  std::optional<std::pair<std::uint32_t, Sha256>>
      prompt_;  // the last task's: that of all of its episodes
};

}  // namespace probe::plan
