// A stored trace is believed when row, file and plan say the same of it.
#include "runtime/store/proof.h"

#include <functional>

#include "runtime/rejudge/rescore.h"
#include "tests/runtime/rejudge/made_trace.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::rejudge {
namespace {

struct Stored {
  store::Trace trace;
  store::ResultRow row;
};

// Written as a run writes it, after `change`, with good hashes.
Stored stored(const plan::Plan& plan, const std::string& path,
              const std::function<void(store::Trace&)>& change = {}) {
  Stored out{made_trace(plan, 0), {}};
  store::Trace& trace = out.trace;
  const plan::TaskRecord& task = plan.tasks()[0];
  const plan::EpisodeRecord& episode = plan.episodes(task)[1];
  trace.header.plan_root = plan.root();
  trace.header.episode = 1;
  trace.header.start_id = Sha256{episode.start_id};
  trace.header.episode_id = Sha256{episode.episode_id};
  trace.header.horizon = task.horizon;
  const auto score = rescore(plan, 0, trace);
  REQUIRE(score.ok());
  for (std::size_t i = 0; i < trace.steps.size(); ++i) trace.steps[i].metrics = score->steps[i];
  trace.end = store::TraceEnd{task.horizon, score->metrics, std::nullopt};
  for (const store::MetricValue& metric : score->metrics)
    trace.header.metrics.push_back({metric.name, metric.is_bool});
  if (change) change(trace);
  auto writer = store::TraceWriter::create(path, trace.header);
  REQUIRE(writer.ok());
  REQUIRE((*writer)->start(*trace.start).ok());
  for (const store::TraceStep& step : trace.steps) REQUIRE((*writer)->step(step).ok());
  const auto hash = (*writer)->finish(*trace.end);
  REQUIRE(hash.ok());
  store::ResultRow& row = out.row;
  row.task = trace.header.task;
  row.episode = 1;
  row.metrics = trace.end->metrics;
  row.steps = static_cast<int>(trace.end->steps);
  row.invalid = trace.end->invalid;
  row.trace_sha256 = to_hex(*hash);
  row.start_id = to_hex(trace.header.start_id);
  row.episode_id = to_hex(trace.header.episode_id);
  row.trace = path;
  return out;
}

}  // namespace

TEST_CASE("a trace is proven by its row, its header and the verdicts of its own plan") {
  run::TemporaryFolder folder;
  const plan::Plan plan = small();
  const std::string path = folder / "a.trace";
  const auto message = [&](const store::ResultRow& row) {
    const auto trace = store::prove(plan, row);
    return trace.ok() ? std::string() : std::string(to_word(trace.failure().code)) + ": " + trace.failure().message;
  };
  const store::ResultRow good = stored(plan, path).row;
  CHECK(message(good).empty());

  const auto forged = [&](auto&& change) {
    store::ResultRow row = good;
    change(row);
    return message(row);
  };
  const std::string other = "trace: this trace is not the one its result row was made with";
  CHECK(forged([](store::ResultRow& r) { r.episode = 0; }).starts_with(other));
  CHECK(forged([](store::ResultRow& r) { r.policy = "better"; }).starts_with(other));
  CHECK(forged([](store::ResultRow& r) { r.start_id[0] ^= 1; }).starts_with(other));
  CHECK(forged([](store::ResultRow& r) { r.episode_id[9] ^= 1; }).starts_with(other));
  CHECK(forged([](store::ResultRow& r) { r.trace_sha256[3] ^= 1; }).starts_with(other));
  CHECK(forged([](store::ResultRow& r) { r.metrics[0].value = 1 - r.metrics[0].value; }) ==
        "trace: this trace ended with other verdicts than its result row says");
  CHECK(forged([](store::ResultRow& r) { r.steps = 30; }) ==
        "trace: this trace has 60 steps, its result row says 30");
  CHECK(forged([](store::ResultRow& r) { r.invalid = "it was unlucky"; }) ==
        "trace: this trace ended with other verdicts than its result row says");
}

TEST_CASE("a forger who seals a trace with fresh hashes is found by judging it again") {
  run::TemporaryFolder folder;
  const plan::Plan plan = small();
  const auto message = [&](const std::function<void(store::Trace&)>& change) {
    const store::ResultRow row = stored(plan, folder / "forged.trace", change).row;
    const auto trace = store::prove(plan, row);
    return trace.ok() ? std::string() : trace.failure().message;
  };
  const std::string lies = "its verdicts are not what its own plan says of its measurements";
  CHECK(message([](store::Trace&) {}).empty());
  CHECK(message([](store::Trace& t) { t.end->metrics[0].value = 1 - t.end->metrics[0].value; }) ==
        lies);
  CHECK(message([](store::Trace& t) { t.steps[20].metrics[0] = 0; }) == lies);
  // A measurement that decides.
  CHECK(message([](store::Trace& t) { t.steps[2].sample.tcp.x() = 0.3; }) == lies);
  CHECK(message([](store::Trace& t) { t.header.plan_root.bytes[0] ^= 1; }) ==
        "this trace was not made under the stored plan");
  CHECK(message([](store::Trace& t) { t.steps.pop_back(), --t.end->steps; }) ==
        "this trace has 59 of the task's 60 steps and gives no reason");
  // An episode may end early, but then it says why, and its row too.
  CHECK(message([](store::Trace& t) {
          t.steps.resize(30);
          t.end->steps = 30;
          t.end->invalid = "policy: gone";
        }).empty());
}

}  // namespace probe::rejudge
