// The runs that a dataset names, and its demonstrations one after the other, each with its trace.
#pragma once

#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/export/dataset/demonstration.h"
#include "runtime/plan/plan.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::dataset {

// A line of demonstrations.jsonl with what it stands for.
struct NamedDemonstration {
  std::string name;                  // for messages
  std::string dir;                   // of its run, as it is now
  const plan::Plan* plan = nullptr;  // its run's; lives as long as the NamedRuns
  std::string trace_sha256;
  store::Trace trace;
  std::vector<std::string> wordings;
  bool success = false;
  Pose base;  // of the robot in the world
  // The dataset has every camera of its task, in order and in the size in which the policy saw it.
  bool has_all_pictures = false;
};

class NamedRuns {
 public:
  // As check_dataset.
  static Result<NamedRuns> open(const std::string& dir, const std::vector<std::string>& runs);

  const Shape& shape() const { return shape_; }
  bool only_success() const { return only_success_; }
  // The next one, or nothing behind the last. Fails (kTrace or kUsage) where it is not the run's.
  Result<std::optional<NamedDemonstration>> next();

 private:
  struct Run {
    std::string dir;
    plan::Plan plan;
    std::map<store::EpisodeKey, store::ResultRow> rows;
  };
  NamedRuns() = default;
  Shape shape_;
  bool only_success_ = false;
  std::map<std::string, Run> runs_;  // by the name in the dataset
  std::string path_;
  std::ifstream lines_;
  std::size_t line_ = 0;
};

}  // namespace probe::dataset
