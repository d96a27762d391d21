// A policy in process and the same one served: the first run's actions become what the server
// answers, found by each episode's first picture, and the two runs have to agree in every bit.
#pragma once

#include <doctest/doctest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "runtime/run/run.h"
#include "runtime/store/store.h"
#include "runtime/store/trace.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
using namespace probe::store;

class ServedRun {
 public:
  // The suite's carrot_on_plate: 24 starts, run by the scripted expert. In small pictures the same
  // is done in a third of the time.
  enum class Pictures { kWhole, kSmall };
  explicit ServedRun(Pictures pictures = Pictures::kWhole) {
    const std::string text = folder_ / "small.probe";
    std::ofstream(text) << R"(use "suite/intact.probe"
camera small like third_view { image 160 x 120; lens 155.9px, 155.9px, 79.6px, 59.6px }
variant small_carrot_on_plate of carrot_on_plate { camera small }
suite small { tasks { small_carrot_on_plate }; seeds 42 }
)";
    const bool is_small = pictures == Pictures::kSmall;
    task_ = is_small ? "small_carrot_on_plate" : "carrot_on_plate";
    const std::string files[] = {is_small ? text : VLAPROBE_SOURCE_DIR "/suite/intact.probe"};
    auto compiled =
        build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                      .suite = is_small ? "small" : "",
                      .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
    REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
    REQUIRE_FALSE(compiled->plan.empty());
    auto opened = plan::Plan::from_bytes(std::move(compiled->plan));
    REQUIRE(opened.ok());
    plan_ = std::make_unique<plan::Plan>(std::move(*opened));
    in_process_ = rows_of("expert", folder_ / "in_process", 2);
    write_actions();
  }

  std::string in_process_folder() const { return folder_ / "in_process"; }
  // Of the last check.
  std::string served_folder() const { return folder_ / ("served" + std::to_string(runs_)); }

  // What recorded_actions.load of tests/servers reads: a line an episode.
  std::string actions_file() const { return folder_ / "actions"; }

  // The same episodes asked of `policy`: everything in a row and in a trace but timing is equal.
  void check_equal(const std::string& policy, int jobs = 2) {
    CAPTURE(policy);
    const auto served = rows_of(policy, folder_ / ("served" + std::to_string(++runs_)), jobs);
    REQUIRE(served.size() == 24);
    REQUIRE(in_process_.size() == 24);
    for (std::size_t i = 0; i < served.size(); ++i) {
      const ResultRow& here = in_process_[i];
      const ResultRow& there = served[i];
      CAPTURE(here.episode);
      REQUIRE_MESSAGE(!there.invalid, there.invalid.value_or(""));
      CHECK(there.episode == here.episode);
      CHECK(there.metrics == here.metrics);
      CHECK(there.frames_sha256 == here.frames_sha256);
      const auto local = read_trace(here.trace), remote = read_trace(there.trace);
      REQUIRE((local.ok() && remote.ok()));
      REQUIRE(local->steps.size() == remote->steps.size());
      for (std::size_t k = 0; k < local->steps.size(); ++k) {
        CHECK(local->steps[k].action == remote->steps[k].action);
        CHECK(local->steps[k].state_hash == remote->steps[k].state_hash);
      }
      CHECK(there.sent_prompt_sha256 == here.prompt_sha256);
      CHECK_FALSE(here.sent_prompt_sha256.has_value());
    }
    served_ = served;
  }

  // The same where actions are converted on the way, which rounds: every truth is equal.
  void check_alike(const std::string& policy, int jobs = 2) {
    CAPTURE(policy);
    const auto served = rows_of(policy, folder_ / ("served" + std::to_string(++runs_)), jobs);
    REQUIRE(served.size() == in_process_.size());
    for (std::size_t i = 0; i < served.size(); ++i) {
      CAPTURE(served[i].episode);
      REQUIRE_MESSAGE(!served[i].invalid, served[i].invalid.value_or(""));
      REQUIRE(served[i].metrics.size() == in_process_[i].metrics.size());
      for (std::size_t k = 0; k < served[i].metrics.size(); ++k) {
        if (!served[i].metrics[k].is_bool) continue;
        CHECK(served[i].metrics[k] == in_process_[i].metrics[k]);
      }
    }
  }

  const std::vector<ResultRow>& served() const { return served_; }

 private:
  std::vector<ResultRow> rows_of(const std::string& policy, const std::string& out, int jobs) {
    RunOptions options;
    options.policy = policy;
    options.out = out;
    options.tasks = task_;
    options.seeds = {42};
    options.jobs = jobs;
    options.assets = VLAPROBE_SOURCE_DIR "/assets";
    const auto summary = run(*plan_, options);
    REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
    auto rows = read_results(out);
    REQUIRE(rows.ok());
    return *rows;
  }

  void write_actions() {
    std::ofstream file(actions_file());
    for (const ResultRow& row : in_process_) {
      const auto trace = read_trace(row.trace);
      REQUIRE(trace.ok());
      file << row.image_sha256;
      for (const TraceStep& step : trace->steps) {
        for (const double number : step.action) {
          char text[40];
          std::snprintf(text, sizeof text, " %a", number);
          file << text;
        }
      }
      file << '\n';
    }
  }

  TemporaryFolder folder_;
  std::string task_;
  std::unique_ptr<plan::Plan> plan_;
  std::vector<ResultRow> in_process_, served_;
  int runs_ = 0;
};

}  // namespace probe::run
