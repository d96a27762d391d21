// Makes the bytes of a plan from tables of records. Same calls, same bytes. Adds what no author
// should write by hand: interned strings, hashes, ids, layout. Knows nothing of the language.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/result.h"
#include "runtime/plan/format.h"
#include "runtime/plan/tables.h"
#include "runtime/plan/verify.h"

namespace probe::plan {

// What holds the records of a section while they are gathered.
template <typename Record>
using Gathered = std::conditional_t<std::is_same_v<Record, char>, std::string, std::vector<Record>>;

// Tables under construction, one member a line of sections.def; the index of a pushed record is its
// id. `strings` only through Writer::text, `list` and `reals` through the methods of their names,
// `texts` and `text_bytes` through Writer::source.
struct Records {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) Gathered<Record> member;
#include "runtime/plan/sections.def"

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

  // Fills ProgramRecord::hash, TaskRecord::judge_id, EpisodeRecord::start_id and episode_id,
  // QuestionRecord::question_id, lays everything out and verifies the result. A Failure means that
  // the records break a rule of FORMAT.md.
  // Without `options.identity` ids are not computed once more to be sure of them.
  Result<std::vector<std::byte>> finish(const VerifyOptions& options = {});

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

using probe::write_file;  // whole or absent

}  // namespace probe::plan
