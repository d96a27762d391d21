// Folders of a million rows without a million episodes: the traces of two short runs of one plan
// are written again under other seeds, each row proven by its own trace as any other's. What is in
// them was simulated once a start and policy; that it is there again under other seeds is made up,
// and the policy's name says so.
//
//   many_rows RUN_A RUN_B -o DIR [--seeds 100] [--share 0.5] [--shard I/N]
//
// An episode is A's with the chance `share`, else B's. Nothing waits for the disk here.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/trace.h"

// The C library's, for all that is linked here.
extern "C" int fsync(int) { return 0; }
extern "C" int fdatasync(int) { return 0; }
extern "C" int syncfs(int) noexcept { return 0; }

namespace probe {
namespace {

struct Options {
  std::vector<std::string> runs;
  std::string out;
  int seeds = 100, shard = 1, shards = 1;
  double share = 0.5;
};

struct Template {
  store::ResultRow row;
  store::Trace trace;
};
using Templates = std::map<std::pair<std::string, int>, Template>;  // by task and episode

Result<Templates> read_templates(const std::string& dir) {
  PROBE_ASSIGN(auto proven, store::read_proven_results(dir));
  Templates all;
  for (store::ResultRow& row : proven.rows) {
    PROBE_ASSIGN(store::Trace trace, store::read_trace(row.trace));
    const std::pair key(row.task, row.episode);
    all[key] = {std::move(row), std::move(trace)};
  }
  return all;
}

Result<store::Store::Finished> write_episode(store::Store& store, const plan::Plan& plan,
                                             const Template& from, const std::string& policy,
                                             int seed) {
  store::ResultRow row = from.row;
  row.seed = seed;
  row.policy = policy;
  PROBE_ASSIGN(const std::string path, store.temporary_trace(store::key_of(row)));
  store::TraceHeader header = from.trace.header;
  header.seed = seed;
  header.policy = policy;
  PROBE_ASSIGN(auto writer, store::TraceWriter::create(path, header));
  if (from.trace.start) PROBE_TRY(writer->start(*from.trace.start));
  for (const store::TraceStep& step : from.trace.steps) PROBE_TRY(writer->step(step));
  PROBE_ASSIGN(const Sha256 hash, writer->finish(*from.trace.end));
  row.trace_sha256 = to_hex(hash);
  const int order = static_cast<int>(plan.find_task(row.task).value_or(0));
  return store::Store::Finished{std::move(row), order};
}

// Uniform in [0, 1).
double draw(const std::string& policy, const store::ResultRow& row, int seed) {
  const std::string text = policy + "/" + store::file_stem({row.task, row.episode, seed});
  return static_cast<double>(little_endian_number(sha256(text)) >> 11) * 0x1p-53;
}

Status make(const Options& options) {
  PROBE_ASSIGN(const Templates a, read_templates(options.runs[0]));
  PROBE_ASSIGN(const Templates b, read_templates(options.runs[1]));
  PROBE_ASSIGN(const plan::Plan plan, store::open_run_plan(options.runs[0]));
  PROBE_ASSIGN(store::RunRecord record, store::read_run_record(options.runs[0]));
  char name[40];
  std::snprintf(name, sizeof name, "made_up_%g", options.share);
  record.identity.policy = name;
  record.identity.policy_content.clear();
  record.seeds.clear();
  for (int seed = 0; seed < options.seeds; ++seed) record.seeds.push_back(seed);
  PROBE_ASSIGN(auto store, store::Store::open(options.out, record, plan.bytes()));
  std::vector<store::Store::Finished> finished;
  std::size_t count = 0;
  for (const auto& [key, one] : a) {
    const auto other = b.find(key);
    if (other == b.end()) continue;
    for (int seed = options.shard - 1; seed < options.seeds; seed += options.shards) {
      const bool is_first = draw(name, one.row, seed) < options.share;
      PROBE_ASSIGN(auto made, write_episode(*store, plan, is_first ? one : other->second, name, seed));
      finished.push_back(std::move(made));
      ++count;
    }
    PROBE_TRY(store->commit(finished));
    finished.clear();
  }
  std::printf("%s: %zu rows\n", options.out.c_str(), count);
  return {};
}

int main_of(std::span<char*> words) {
  Options options;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view word = words[i];
    const bool has_value = word.starts_with("-") && i + 1 < words.size();
    const char* value = has_value ? words[++i] : "";
    if (word == "-o") {
      options.out = value;
    } else if (word == "--seeds") {
      options.seeds = std::atoi(value);
    } else if (word == "--share") {
      options.share = std::atof(value);
    } else if (word == "--shard") {
      if (std::sscanf(value, "%d/%d", &options.shard, &options.shards) != 2) options.out.clear();
    } else {
      options.runs.emplace_back(word);
    }
  }
  if (options.runs.size() != 2 || options.out.empty()) {
    std::fputs("many_rows RUN_A RUN_B -o DIR [--seeds 100] [--share 0.5] [--shard I/N]\n", stderr);
    return 1;
  }
  const Status made = make(options);
  if (made) return 0;
  std::fprintf(stderr, "many_rows: %s\n", to_text(made.failure()).c_str());
  return 2;
}

}  // namespace
}  // namespace probe

int main(int count, char** words) {
  return probe::main_of({words, static_cast<std::size_t>(count)});
}
