// A small run of a table with a carrot and a plate, and what is made of it, for tests of datasets.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/export/dataset/dataset.h"
#include "runtime/plan/starts_hash.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::dataset {

inline constexpr int kEpisodes = 4, kHorizon = 7;

inline plan::Plan small_table(int width = 96, int height = 64) {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  auto bytes = table.write(kEpisodes, kHorizon, [&](plan::Records& records) {
    for (plan::CameraRecord& camera : records.cameras) {
      const double across = static_cast<double>(width) / camera.width,
                   down = static_cast<double>(height) / camera.height;
      camera.fx *= across;
      camera.cx *= across;
      camera.fy *= down;
      camera.cy *= down;
      camera.width = static_cast<std::uint32_t>(width);
      camera.height = static_cast<std::uint32_t>(height);
    }
  });
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : to_text(bytes.failure())));
  return plan::Plan::from_bytes(std::move(*bytes)).value();
}

// The same table, its arm told positions of its joints.
inline plan::Plan told_table() {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  auto bytes = table.write(2, kHorizon, [](plan::Records& records) {
    records.robots[0].control = static_cast<std::uint32_t>(plan::Control::kJointPosition);
    const plan::LawRecord law;
    records.robots[0].law = plan::append(records.laws, std::span<const plan::LawRecord>(&law, 1));
    records.cameras[0].width = records.cameras[0].height = 32;
  });
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : to_text(bytes.failure())));
  return plan::Plan::from_bytes(std::move(*bytes)).value();
}

inline void make_run(const plan::Plan& plan, const std::string& dir,
                     const std::string& policy = "random") {
  run::RunOptions options = run::options_for(dir, policy);
  options.seeds = {42};
  run::must_run(plan, options);
}

inline std::vector<store::StoredTrace> traces_of(const std::string& dir) {
  const auto rows = store::read_results(dir);
  REQUIRE(rows.ok());
  std::vector<store::StoredTrace> all;
  for (const store::ResultRow& row : *rows) {
    auto trace = store::read_stored_trace(row);
    REQUIRE_MESSAGE(trace.ok(), (trace.ok() ? "" : to_text(trace.failure())));
    all.push_back({row, std::move(*trace)});
  }
  return all;
}

// A table with one other wording of the run's task, proved for its starts.
inline void write_wording(const std::string& run, const std::string& path) {
  const auto plan = store::open_run_plan(run);
  REQUIRE(plan.ok());
  const plan::TaskRecord& task = plan->tasks()[0];
  const Json line = {{"task", plan->text(task.name)},      {"original", plan->text(task.prompt)},
                     {"wording", "lay it down"},           {"split", "train"},
                     {"probability", 0.5},                 {"original_probability", 0.5},
                     {"starts_sha256", to_hex(plan::starts_hash(*plan, task))}};
  std::ofstream(path) << line.dump() << "\n";
}

inline DatasetOptions dataset_options() {
  DatasetOptions options;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return options;
}

inline DatasetReport must_export(const std::string& run, const std::string& out, Format format,
                                 const DatasetOptions& options) {
  const auto done = export_dataset({run}, out, format, options);
  REQUIRE_MESSAGE(done.ok(), (done.ok() ? "" : to_text(done.failure())));
  return *done;
}

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// By path below the folder.
inline std::map<std::string, std::string> all_files(const std::string& dir) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), dir).generic_string()] =
          text_of(entry.path().string());
  }
  return files;
}

}  // namespace probe::dataset
