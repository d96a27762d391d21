// Makes the bytes of a plan from tables of records. Same calls, same bytes. Adds what no author
// should write by hand: interned strings, hashes, ids, layout. Knows nothing of the language.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/result.h"
#include "runtime/plan/format.h"
#include "runtime/plan/tables.h"

namespace probe::plan {

// Tables under construction; the index of a pushed record is its id. Same member names as Tables.
struct Records {
  std::string strings;              // only through Writer::text
  std::vector<std::uint32_t> list;  // only through Writer::list
  std::vector<double> reals;        // Writer::reals
  std::vector<AssetRecord> assets;
  std::vector<ObjectRecord> objects;
  std::vector<RobotRecord> robots;
  std::vector<DriveRecord> drives;
  std::vector<CameraRecord> cameras;
  std::vector<LightRecord> lights;
  std::vector<SunRecord> suns;
  std::vector<SceneRecord> scenes;
  std::vector<double> constants;
  std::vector<StateRecord> states;
  std::vector<Instruction> code;
  std::vector<ProgramRecord> programs;
  std::vector<MetricRecord> metrics;
  std::vector<BodyRecord> bodies;
  std::vector<PlacementRecord> placements;
  std::vector<TaskRecord> tasks;
  std::vector<EpisodeRecord> episodes;
  std::vector<SetRecord> sets;
  std::vector<SuiteRecord> suites;
  std::vector<ViewRecord> views;
  std::vector<SpanRecord> spans;
  std::vector<TextRecord> texts;  // only through Writer::source
  std::string text_bytes;

  Tables tables() const;  // valid until the next change
};

class Writer {
 public:
  Records records;

  // Interned by first use.
  StringRef text(std::string_view value);
  // Appends numbers; lists are never shared between records.
  Slice list(std::span<const std::uint32_t> values);
  Slice reals(std::span<const double> values);
  // Appends a source file for `why` and `dis`; returns its index for SpanRecord::text.
  std::uint32_t source(std::string_view path, std::string_view bytes);

  // Fills ProgramRecord::hash, TaskRecord::judge_id, EpisodeRecord::start_id and episode_id, lays
  // everything out and verifies the result. A Failure means that the records break a rule of
  // FORMAT.md.
  Result<std::vector<std::byte>> finish();

  // The same without verifying, and without computing ids when they are filled already: for tests
  // of the verifier. Ids are only computed when every index they follow is in range.
  void fill_ids();
  std::vector<std::byte> lay_out() const;

 private:
  std::unordered_map<std::string, StringRef> interned_;
};

// Appends records to a table and returns where they stand: writer.records.bodies, task bodies ->
// Slice.
template <typename Record>
Slice append(std::vector<Record>& table, std::span<const Record> records) {
  const Slice slice{static_cast<std::uint32_t>(table.size()),
                    static_cast<std::uint32_t>(records.size())};
  table.insert(table.end(), records.begin(), records.end());
  return slice;
}

// The same plan without its ignorable sections: same root, same ids. `bytes` is a verified plan.
std::vector<std::byte> strip_sources(std::span<const std::byte> bytes);

using probe::write_file;  // whole or absent

}  // namespace probe::plan
