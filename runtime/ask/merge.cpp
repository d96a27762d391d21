// Two passes over all rows: what is chosen, then what is written. Holds two hashes a row.
#include "runtime/ask/merge.h"

#include <filesystem>
#include <map>
#include <set>

#include "runtime/ask/answer_fields.h"
#include "runtime/ask/answer_table.h"
#include "runtime/ask/answers.h"
#include "runtime/ask/vouch.h"
#include "runtime/base/paths.h"
#include "runtime/plan/family_name.h"

namespace probe::ask {
namespace {

namespace fs = std::filesystem;

struct AnswerSource {
  std::string dir;
  AskRecord record;
  std::vector<AskCall> calls;
};

// The best row of a key so far.
struct BestAnswer {
  Sha256 content;
  std::size_t source = 0;
  bool is_valid = false;
};

Sha256 key_hash(const AnswerRow& row) {
  Hasher hasher;
  for (std::size_t field = 0; field < kKeyFields; ++field) hasher.text(cell_of(row, field).dump());
  return hasher.finish();
}

// What was sent, said and read; not how long it took.
Sha256 content_hash(const AnswerRow& row) {
  Hasher hasher;
  hasher.text(row.text).text(row.image_sha256).text(row.raw).text(row.expected);
  return hasher.u8(row.right ? (*row.right ? 2 : 1) : 0).finish();
}

std::string named(const AnswerRow& row) {
  std::string text = row.task + " episode " + std::to_string(row.episode);
  if (row.seed >= 0) text += " seed " + std::to_string(row.seed);
  return text + ", " + plan::family_name(row.set, row.family) + ", rotation " +
         std::to_string(row.rotation) + ", " + std::string(word_of(row.arm));
}

std::vector<std::string> folders(const store::MergeOptions& options, bool with_out) {
  std::vector<std::string> all;
  std::set<fs::path> known;
  const auto add = [&](const std::string& dir) {
    std::error_code error;
    const fs::path place = fs::weakly_canonical(dir, error);
    if (known.insert(error ? fs::path(dir) : place).second) all.push_back(dir);
  };
  if (with_out) add(options.out);
  for (const std::string& dir : options.dirs) add(dir);
  return all;
}

// Every folder against the first; the first difference is told.
Status check_same_asking(const std::vector<AnswerSource>& sources, bool mixed_builds,
                         std::vector<std::string>& notes) {
  const AnswerSource& first = sources.front();
  std::set<std::string> told;
  for (const AnswerSource& source : sources) {
    std::vector<store::Fingerprint> builds = {source.record.fingerprint};
    for (const AskCall& call : source.calls) builds.push_back(call.fingerprint);
    for (const store::Fingerprint& build : builds) {
      AskRecord other = source.record;
      other.fingerprint = build;
      const AskChanges changes = changes_between(other, first.record);
      for (const std::string& change : {changes.identity, changes.content}) {
        if (change.empty()) continue;
        return Failure{Fault::kUsage,
                       change + ", as " + first.dir + " does; they are not parts of one asking",
                       source.dir};
      }
      if (changes.build.empty()) continue;
      if (!mixed_builds) {
        return Failure{Fault::kUsage,
                       changes.build + " than " + first.dir +
                           "; their pictures may differ; --mixed-builds joins them all the same",
                       source.dir};
      }
      const std::string note = source.dir + " " + changes.build + " than " + first.dir;
      if (told.insert(note).second) notes.push_back(note);
    }
  }
  return {};
}

Status choose(const std::vector<AnswerSource>& sources, std::map<Sha256, BestAnswer>& best,
              store::MergeSummary& summary) {
  for (std::size_t i = 0; i < sources.size(); ++i) {
    RowFindings rows;
    PROBE_TRY(for_each_answer(sources[i].dir, [&](AnswerRow row, std::uint32_t) -> Status {
      rows.add(row);
      const BestAnswer here{content_hash(row), i, !row.invalid};
      const auto [at, is_new] = best.try_emplace(key_hash(row), here);
      if (is_new) return {};
      ++summary.duplicates;
      BestAnswer& known = at->second;
      if (!here.is_valid) return {};
      if (!known.is_valid) {
        known = here;
        return {};
      }
      if (known.content == here.content) return {};
      return Failure{Fault::kStore,
                     named(row) + " has another answer here than in " + sources[known.source].dir +
                         "; nothing was merged",
                     sources[i].dir};
    }));
    summary.unvouched += static_cast<int>(rows.refused());
    for (const std::string& sentence : rows.sentences())
      summary.notes.push_back(sources[i].dir + ": " + sentence);
  }
  return {};
}

Status take_calls(const std::vector<AnswerSource>& sources, Answers& answers,
                  const std::string& out) {
  PROBE_ASSIGN(const auto there, read_ask_calls(out));
  std::set<std::string> known;
  for (const AskCall& call : there) known.insert(call_to_json(call));
  for (const AnswerSource& source : sources) {
    for (const AskCall& call : source.calls) {
      if (known.insert(call_to_json(call)).second) PROBE_TRY(answers.add_call(call));
    }
  }
  return {};
}

}  // namespace

Result<store::MergeSummary> merge(const store::MergeOptions& options) {
  store::MergeSummary summary;
  if (options.dirs.empty()) return Failure{Fault::kUsage, "no folder to merge", "DIR"};
  PROBE_ASSIGN(const auto there, find_ask_record(options.out));
  std::vector<AnswerSource> sources;
  for (const std::string& dir : folders(options, there.has_value())) {
    // Its database is made before anything stands in it.
    if (is_there(answers_path(dir))) {
      PROBE_ASSIGN(const auto begun, find_ask_record(dir));
      if (!begun) {
        summary.notes.push_back(dir + " has no answers: what asked was cut off as it began");
        continue;
      }
    }
    auto record = read_ask_record(dir);
    if (!record)
      return Failure{Fault::kUsage, "cannot be merged: " + record.failure().message, dir};
    PROBE_ASSIGN(auto calls, read_ask_calls(dir));
    sources.push_back({dir, std::move(*record), std::move(calls)});
  }
  if (sources.empty())
    return Failure{Fault::kUsage, "none of these folders has answers", options.dirs.front()};
  PROBE_TRY(check_same_asking(sources, options.mixed_builds, summary.notes));
  for (const AnswerSource& source : sources) {
    if (auto own = open_asked_plan(source.dir); !own) return own.failure();
  }
  std::map<Sha256, BestAnswer> best;
  PROBE_TRY(choose(sources, best, summary));
  PROBE_ASSIGN(const plan::Plan plan, open_asked_plan(sources.front().dir));
  PROBE_ASSIGN(auto answers, Answers::open(options.out, sources.front().record, plan.bytes()));
  PROBE_TRY(take_calls(sources, *answers, options.out));
  std::vector<AskCall> calls;
  for (const AnswerSource& source : sources)
    calls.insert(calls.end(), source.calls.begin(), source.calls.end());
  if (const std::string missing = missing_shards(calls); !missing.empty())
    summary.notes.push_back(options.out + " " + missing);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const bool is_there = there && i == 0;
    PROBE_TRY(for_each_answer(sources[i].dir, [&](AnswerRow row, std::uint32_t place) -> Status {
      const BestAnswer& chosen = best.at(key_hash(row));
      if (chosen.source != i) return {};
      ++summary.rows;
      if (row.invalid) ++summary.invalid;
      if (is_there) return {};
      ++summary.added;
      row.reader = kReaderVersion;  // as it was read just now
      return answers->commit(row, place);
    }));
    if (is_there) continue;
    PROBE_TRY(for_each_left_out(sources[i].dir, [&](LeftOut out, std::uint32_t place) {
      return answers->leave_out(out, place);
    }));
  }
  PROBE_TRY(answers->flush());
  return summary;
}

}  // namespace probe::ask
