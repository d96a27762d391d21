// A folder of answers (`vlaprobe ask`) as reports use it: scored, and with what is known of each
// start. Reads the folder alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/ask/score.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::report {

struct AskedModel {
  std::string name, label, dir;  // labels are unique
  int plan = 0;                  // of Benchmark::plan_files
  std::int64_t answers = 0, invalid = 0;
  std::int64_t left_out = 0;               // questions that were not asked of a picture
  bool is_unchecked = false;               // asked with --insecure
  std::vector<std::string> findings = {};  // of its server: does it look, does it read
  std::vector<std::string> doubts = {};    // of its rows: ask::RowFindings
  std::vector<ask::ScoreRow> scores = {};  // all tasks, then by set of the plan
  // What was right, and what was wrong; not what is missing or invalid.
  struct Known {
    std::uint32_t family = 0;    // of the plan's families
    int task = 0, start = 0;     // of the plan; of the benchmark in Benchmark::models
    std::uint32_t question = 0;  // of the plan's questions
    int seed = -1;               // of the recorded episode; -1: the start
    bool knows = false;          // right in every order of the options
    // Tasks that ask the same of the same start share an answer, and this number.
    std::int64_t shared = -1;
  };
  std::vector<Known> known = {};  // by family
};

// "understanding.source"
std::string family_name(const plan::Plan& plan, std::uint32_t family);
// Whether all its questions ask for the object that is to be moved: what a policy's intention
// shows.
bool asks_for_source(const plan::Plan& plan, std::uint32_t family);

// The answers in `dir`, which are about `plan`. Fails (kStore) as ask::for_each_answer does, and on
// a row that does not fit the plan.
Result<AskedModel> read_asked_model(const std::string& dir, const plan::Plan& plan);

}  // namespace probe::report
