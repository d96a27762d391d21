// A scene with a drawer goes all the way: run, stored, read strictly, replayed, judged again,
// filmed and exported.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "runtime/base/json.h"
#include "runtime/expert/expert.h"
#include "runtime/export/export.h"
#include "runtime/policy/scripted.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/run/episode.h"
#include "runtime/show/episode_video.h"
#include "runtime/store/trace_compare.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/stage/cabinet.h"

namespace probe::exporting {
namespace {

class TraceActions final : public policy::Policy {
 public:
  explicit TraceActions(const store::Trace& trace) : trace_(trace) {}
  Status begin(const policy::EpisodeStart&) override { return {}; }
  Result<policy::Action> act(const policy::Observation& seen) override {
    return trace_.steps[static_cast<std::size_t>(seen.step)].action;
  }

 private:
  const store::Trace& trace_;
};

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("episodes beside a drawer are stored, replayed, judged again, filmed and exported") {
  const plan::Plan& plan = test::suite_plan();
  const auto stage = test::open_with_cabinet({.image = {80, 60}});
  const auto again = test::open_with_cabinet({.image = {80, 60}});
  const run::EpisodeJob job{stage->task(), 0, 42};
  const run::TemporaryFolder folder;
  auto expert = expert::make_expert({});
  REQUIRE(expert.ok());
  struct Named {
    std::string name;
    std::unique_ptr<policy::Policy> policy;
  };
  std::vector<Named> policies;
  policies.push_back({"null", policy::make_null()});
  policies.push_back({"random", policy::make_random()});
  policies.push_back({"expert", std::move(*expert)});
  auto json = open_json_lines(folder / "all.jsonl");
  REQUIRE(json.ok());
  for (Named& one : policies) {
    CAPTURE(one.name);
    const std::string path = folder / (one.name + ".trace");
    const auto header = run::make_trace_header(plan, job, *stage, one.name, "{}");
    auto writer = store::TraceWriter::create(path, header);
    REQUIRE(writer.ok());
    show::EpisodeVideo video(header, folder / (one.name + ".mp4"));
    const auto played =
        run::run_episode(*stage, plan, job, one.name, *one.policy, **writer, &video);
    REQUIRE_MESSAGE(played.ok(), (played.ok() ? "" : to_text(played.failure())));
    REQUIRE_MESSAGE(!played->row.invalid, played->row.invalid.value_or(""));
    REQUIRE(video.finish().ok());
    CHECK(std::filesystem::file_size(folder / (one.name + ".mp4")) > 1000);

    const auto trace = store::read_trace(path);
    REQUIRE_MESSAGE(trace.ok(), (trace.ok() ? "" : to_text(trace.failure())));
    CHECK(trace->header.joints.back() == "cabinet.press");
    CHECK(trace->header.bodies.back() == "cabinet.button");
    CHECK(to_hex(trace->hash) == played->row.trace_sha256);
    // What the judge reads of the joints stands in the record.
    CHECK(trace->steps.back().sample.joints.size() == trace->header.joints.size());

    TraceActions actions(*trace);
    store::TraceComparer comparer(*trace);
    const auto replayed = run::run_episode(*again, plan, job, one.name, actions, comparer);
    REQUIRE(replayed.ok());
    CHECK_MESSAGE(comparer.difference().empty(), comparer.difference());
    CHECK(comparer.steps() == static_cast<int>(trace->steps.size()));

    const auto rescored = rejudge::rescore(plan, job.task, *trace);
    REQUIRE_MESSAGE(rescored.ok(), (rescored.ok() ? "" : to_text(rescored.failure())));
    CHECK(rescored->metrics == played->row.metrics);

    REQUIRE((*json)->episode(played->row, *trace).ok());
    auto hdf5 = open_hdf5(folder / (one.name + ".h5"));  // one episode of a start in a file
    REQUIRE(hdf5.ok());
    REQUIRE((*hdf5)->episode(played->row, *trace).ok());
    REQUIRE((*hdf5)->finish().ok());
    CHECK(std::filesystem::file_size(folder / (one.name + ".h5")) > 1000);
    // Friction holds the tray while nothing pushes it.
    if (one.name == "null") CHECK(trace->steps.back().q[8] == doctest::Approx(0.1).epsilon(1e-3));
    // From the tray to the plate.
    if (one.name == "expert") CHECK(played->row.metrics[0].value == 1);
  }
  REQUIRE((*json)->finish().ok());
  const std::string lines = text_of(folder / "all.jsonl");
  const Json first = Json::parse(lines.substr(0, lines.find('\n')));
  CHECK(first["joints"][8] == "cabinet.slide");
  CHECK(first["bodies"].size() == stage->body_names().size());
  CHECK(lines.find("cabinet.tray") != std::string::npos);
}

}  // namespace
}  // namespace probe::exporting
