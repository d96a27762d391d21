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
  row.prompt_sha256 = to_hex(sha256(trace.header.prompt));
  if (row.steps > 0) {
    row.image_sha256 = to_hex(trace.steps.front().image_hash);
    Hasher frames;
    for (const store::TraceStep& step : trace.steps) frames.hash(step.image_hash);
    row.frames_sha256 = to_hex(frames.finish());
  }
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

TEST_CASE("a row says of instruction and pictures what its trace says, or it is refused") {
  run::TemporaryFolder folder;
  const plan::Plan plan = small();
  const std::string path = folder / "a.trace";
  const store::ResultRow good = stored(plan, path).row;
  const std::string prompt(plan.text(plan.tasks()[0].prompt)), other(64, 'a');
  const auto message = [&](auto&& change) {
    store::ResultRow row = good;
    change(row);
    const auto trace = store::prove(plan, row);
    return trace.ok() ? std::string() : trace.failure().message;
  };
  const auto not_of = [](const std::string& column, const std::string& what) {
    return "its result row's `" + column + "` is not that of " + what;
  };
  const std::string said = "the instruction that this trace was told",
                    pictures = "the pictures in this trace";
  CHECK(message([](store::ResultRow&) {}).empty());
  CHECK(message([&](store::ResultRow& r) { r.prompt_sha256 = other; }) ==
        not_of("prompt_sha256", said));
  CHECK(message([&](store::ResultRow& r) { r.image_sha256 = other; }) ==
        not_of("image_sha256", pictures));
  CHECK(message([](store::ResultRow& r) { r.image_sha256.clear(); }) ==
        not_of("image_sha256", pictures));
  CHECK(message([&](store::ResultRow& r) { r.frames_sha256 = other; }) ==
        not_of("frames_sha256", pictures));
  CHECK(message([](store::ResultRow& r) { r.frames_sha256.clear(); }) ==
        not_of("frames_sha256", pictures));

  // What left for a server is the instruction as some profile writes it; of the pictures it is in
  // the row alone.
  const auto sent = [&](const std::string& text, const std::optional<std::string>& image) {
    return message([&](store::ResultRow& r) {
      r.sent_prompt_sha256 = to_hex(sha256(text));
      r.sent_image_sha256 = image;
    });
  };
  CHECK(sent(prompt, other).empty());
  CHECK(sent(prompt + ".", other).empty());
  CHECK(sent(prompt + "!", other) ==
        not_of("sent_prompt_sha256", "a text that the instruction can be sent as"));
  const std::string no_hash = "its result row's `sent_image_sha256` is no hash";
  CHECK(sent(prompt, "\x1b[31m") == no_hash);
  CHECK(sent(prompt, std::string(64, 'A')) == no_hash);
  CHECK(sent(prompt, std::nullopt) ==
        "its result row has one of `sent_prompt_sha256` and `sent_image_sha256` without the other");
  // Rows of older programs and of policies in this process have neither.
  CHECK(!good.sent_prompt_sha256);
}

TEST_CASE("an episode that failed at its first picture has a hash of that picture or none") {
  run::TemporaryFolder folder;
  const plan::Plan plan = small();
  const store::ResultRow good = stored(plan, folder / "a.trace", [](store::Trace& t) {
                                  t.steps.clear();
                                  t.end->steps = 0;
                                  t.end->invalid = "policy: gone";
                                }).row;
  const auto is_borne = [&](const std::string& image, const std::string& frames, int steps) {
    store::ResultRow row = good;
    row.image_sha256 = image;
    row.frames_sha256 = frames;
    row.steps = steps;
    return store::prove(plan, row).ok();
  };
  CHECK(is_borne("", "", 0));
  CHECK(is_borne(std::string(64, 'a'), "", 0));
  CHECK(!is_borne("a picture", "", 0));
  CHECK(!is_borne("", std::string(64, 'a'), 0));
  CHECK(!is_borne("", "", -1));
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
  // An instruction in the middle that is not the episode's.
  CHECK(message([](store::Trace& t) { t.steps[2].prompt_hash.bytes[0] ^= 1; }) == lies);
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
