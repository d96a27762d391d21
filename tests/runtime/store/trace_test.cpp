// Traces: what goes in comes out, and damage is told.
#include "runtime/store/trace.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "runtime/store/trace_codec.h"
#include "runtime/store/trace_compare.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_trace.h"

namespace probe::store {
using namespace probe::run;
namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST_CASE("a trace comes back as it was written") {
  TemporaryFolder folder;
  const auto hash = write_sample_trace(folder / "a.trace", 4);
  REQUIRE(hash.ok());
  const auto trace = read_trace(folder / "a.trace");
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  CHECK(trace->hash == *hash);
  CHECK(trace->header.prompt == "put carrot on plate");
  CHECK(trace->header.episode == 3);
  CHECK(trace->header.metrics == sample_header().metrics);
  CHECK(trace->header.fingerprint == R"({"cpu":"test"})");
  REQUIRE(trace->steps.size() == 4);
  CHECK(trace->steps[2].action == sample_step(3).action);
  CHECK(trace->steps[2].sample.contacts[0].push.z() == -1e-3 * 3);
  CHECK(std::signbit(trace->steps[2].sample.tcp.y()));
  CHECK(trace->steps[2].render_s == 0.006);
  // What the judge reads of joints is the trace's q and u.
  const TraceStep& third = trace->steps[2];
  REQUIRE(third.sample.joints.size() == third.q.size());
  REQUIRE(!third.q.empty());
  for (std::size_t i = 0; i < third.q.size(); ++i) {
    CHECK(third.sample.joints[i].position == third.q[i]);
    CHECK(third.sample.joints[i].rate == third.u[i]);
  }
  REQUIRE(trace->start->sample.joints.size() == trace->start->q.size());
  CHECK(trace->start->sample.joints[0].position == trace->start->q[0]);
  CHECK(trace->start->sample.joints[0].rate == 0);
  CHECK(trace->end->metrics[1].value == 0.5);
  TraceComparer comparer(*trace);
  CHECK(comparer.start(sample_start()).ok());
  for (int i = 1; i <= 4; ++i) CHECK(comparer.step(sample_step(i)).ok());
  CHECK(comparer.difference() == "");
}

TEST_CASE("a live trace keeps its terms and what each step had of answers") {
  TemporaryFolder folder;
  TraceHeader header = sample_header();
  header.live = policy::LiveTerms{.delay_s = 0.08, .most_held = 0.5};
  const auto write = [&](const std::string& path, double answer_s, std::pair<int, int> asked) {
    auto writer = TraceWriter::create(path, header);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->start(sample_start()).ok());
    for (int i = 0; i < 3; ++i) {
      TraceStep step = sample_step(i + 1);
      step.live.emplace();
      step.live->asks = i < 2;
      if (i == 1) {
        step.live->source = policy::LiveSource::kLate;
        step.live->answers = {{asked.first, answer_s}, {asked.second, 0.01}};
      }
      REQUIRE((*writer)->step(step).ok());
    }
    const auto hash = (*writer)->finish({3, {{"success", true, 1}, {"height", false, 0.5}}, {}});
    REQUIRE(hash.ok());
    return *hash;
  };
  const Sha256 hash = write(folder / "a.trace", 0.25, {0, 1});
  const auto trace = read_trace(folder / "a.trace");
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  CHECK(trace->header.live == header.live);
  REQUIRE(trace->steps.size() == 3);
  REQUIRE(trace->steps[1].live.has_value());
  CHECK(trace->steps[0].live->asks);
  CHECK(trace->steps[0].live->source == policy::LiveSource::kHeld);
  CHECK(trace->steps[1].live->source == policy::LiveSource::kLate);
  const std::vector<policy::LiveAnswer> answers = {{0, 0.25}, {1, 0.01}};
  CHECK(trace->steps[1].live->answers == answers);
  CHECK_FALSE(trace->steps[2].live->asks);
  // The seconds of an answer are the clock's; its step is the trace's.
  CHECK(write(folder / "b.trace", 0.31, {0, 1}) == hash);
  header.live->delay_s.reset();
  CHECK(write(folder / "c.trace", 0.25, {0, 1}) != hash);
  CHECK(read_trace(folder / "c.trace")->header.live->delay_s == std::nullopt);
  // A question that was not asked yet, answers in another order, and one that comes twice.
  for (const std::pair<int, int>& asked : {std::pair{0, 2}, std::pair{1, 0}, std::pair{0, 0}}) {
    write(folder / "d.trace", 0.25, asked);
    const auto wrong = read_trace(folder / "d.trace");
    REQUIRE_FALSE(wrong.ok());
    CHECK(wrong.failure().message.find("an answer to a question that was not asked") == 0);
    std::filesystem::remove(folder / "d.trace");
  }
}

TEST_CASE("a trace says of each step where the motion of what moves by itself has it") {
  TemporaryFolder folder;
  const auto write = [&](const std::string& path, std::vector<std::vector<vm::OwnPlace>> own) {
    auto writer = TraceWriter::create(path, sample_header());
    REQUIRE(writer.ok());
    REQUIRE((*writer)->start(sample_start()).ok());
    for (std::size_t i = 0; i < own.size(); ++i) {
      TraceStep step = sample_step(static_cast<int>(i) + 1);
      step.sample.own = own[i];
      REQUIRE((*writer)->step(step).ok());
    }
    const auto count = static_cast<std::uint32_t>(own.size());
    REQUIRE((*writer)->finish({count, {{"success", true, 1}, {"height", false, 0.5}}, {}}).ok());
  };
  write(folder / "a.trace", {{{1, {1, 2, 3}}}, {{1, {1.5, 2, 3}}}});
  const auto trace = read_trace(folder / "a.trace");
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  REQUIRE(trace->steps[1].sample.own.size() == 1);
  CHECK(trace->steps[1].sample.own[0].body == 1);
  CHECK(trace->steps[1].sample.own[0].position == Vec3(1.5, 2, 3));
  TraceComparer comparer(*trace);
  CHECK(comparer.start(sample_start()).ok());
  TraceStep other = sample_step(1);
  other.sample.own = {{1, {1, 2, 3.5}}};
  CHECK(comparer.step(other).ok());
  CHECK(comparer.difference() == "step 1: where its own motion has `plate` z is 3.5, recorded 3");
  const auto refused = [&](std::vector<std::vector<vm::OwnPlace>> own) {
    write(folder / "b.trace", std::move(own));
    const auto wrong = read_trace(folder / "b.trace");
    REQUIRE_FALSE(wrong.ok());
    return wrong.failure().message.find("a step in which other things move by themselves") == 0;
  };
  const vm::OwnPlace first{0, Vec3::Zero()}, second{1, Vec3::Zero()}, third{2, Vec3::Zero()};
  CHECK(refused({{third}}));
  CHECK(refused({{second, first}}));
  CHECK(refused({{second}, {}}));
  CHECK(refused({{}, {second}}));
}

TEST_CASE("the hash covers everything but the clock") {
  TemporaryFolder folder;
  const auto a = write_sample_trace(folder / "a.trace", 3, 0.006);
  const auto b = write_sample_trace(folder / "b.trace", 3, 0.123);
  const auto c = write_sample_trace(folder / "c.trace", 2, 0.006);
  CHECK(*a == *b);
  CHECK(*a != *c);
}

TEST_CASE("actions of joints say their law and their number, and come back") {
  TemporaryFolder folder;
  TraceHeader header = sample_header();
  header.joints = {"slide", "waist", "elbow", "left_finger"};
  header.joint_actions = {"joint_position", 4};
  const auto write = [&](const TraceHeader& of) {
    auto writer = TraceWriter::create(folder / "a.trace", of);
    REQUIRE(writer.ok());
    TraceStart start = sample_start();
    start.q.assign(4, 0.5);
    REQUIRE((*writer)->start(start).ok());
    TraceStep step = sample_step(1);
    step.q.assign(4, 0.5);
    step.u.assign(4, 0.25);
    step.action = {0.1, -0.2, 1e-300, -1};
    if (of.live) step.live.emplace();
    REQUIRE((*writer)->step(step).ok());
    const auto hash =
        (*writer)->finish({1, {{"success", true, 0}, {"height", false, 0.125}}, std::nullopt});
    REQUIRE(hash.ok());
    return *hash;
  };
  const Sha256 waits = write(header);
  const auto trace = read_trace(folder / "a.trace");
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  CHECK(trace->hash == waits);
  CHECK(trace->header.joint_actions == header.joint_actions);
  CHECK(trace->header.action_size() == 4);
  CHECK(trace->steps[0].action == robot::Action{0.1, -0.2, 1e-300, -1});
  header.live = policy::LiveTerms{};
  CHECK(write(header) != waits);
  const auto live = read_trace(folder / "a.trace");
  REQUIRE_MESSAGE(live.ok(), to_text(live.failure()));
  CHECK(live->header.joint_actions == header.joint_actions);
  CHECK(live->steps[0].action == trace->steps[0].action);
  // More numbers than there are joints and a gripper.
  header.live.reset();
  header.joints = {"waist"};
  auto writer = TraceWriter::create(folder / "a.trace", header);
  REQUIRE(writer.ok());
  writer->reset();
  const auto refused = read_trace_prefix(folder / "a.trace");
  REQUIRE(refused.ok());
  CHECK(refused->incomplete.find("more numbers of an action") == 0);
}

TEST_CASE("a truncated trace is refused, and readable up to its last whole step") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 5).ok());
  const std::string bytes = read_file(folder / "a.trace");
  std::size_t most = 0;
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    write_file(folder / "cut.trace", bytes.substr(0, size));
    const auto strict = read_trace(folder / "cut.trace");
    REQUIRE_FALSE(strict.ok());
    CHECK(strict.failure().code == Fault::kTrace);
    CHECK(strict.failure().where == folder / "cut.trace");
    CHECK(strict.failure().message.find("truncated") != std::string::npos);
    const auto prefix = read_trace_prefix(folder / "cut.trace");
    if (!prefix.ok()) continue;
    CHECK(prefix->steps.size() >= most);
    most = prefix->steps.size();
    for (std::size_t i = 0; i < most; ++i) {
      CHECK(prefix->steps[i].action == sample_step(static_cast<int>(i) + 1).action);
    }
  }
  CHECK(most == 5);
}

TEST_CASE("a flipped bit is found, wherever it is") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 2).ok());
  const std::string bytes = read_file(folder / "a.trace");
  const Sha256 hash = read_trace(folder / "a.trace")->hash;
  int refused = 0, tried = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 5) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    write_file(folder / "flip.trace", damaged);
    const auto trace = read_trace(folder / "flip.trace");
    ++tried;
    if (!trace.ok()) {
      ++refused;
      CHECK_FALSE(trace.failure().message.empty());
      continue;
    }
    // zstd's frame header has bits that change nothing; the content must then be the same.
    CHECK(trace->hash == hash);
    CHECK(trace->steps.size() == 2);
  }
  CHECK(refused > tried * 99 / 100);
}

TEST_CASE("other files are not traces") {
  TemporaryFolder folder;
  CHECK(read_trace(folder / "absent.trace").failure().message == "there is no such file");
  write_file(folder / "text", "put carrot on plate");
  CHECK(read_trace(folder / "text").failure().message.starts_with("not a trace"));
  REQUIRE(write_sample_trace(folder / "a.trace", 1).ok());
  write_file(folder / "more.trace", read_file(folder / "a.trace") + "x");
  CHECK(read_trace(folder / "more.trace").failure().message.find("bytes after the end") !=
        std::string::npos);
  CHECK_FALSE(read_trace(folder.path).ok());
}

TEST_CASE("an episode that failed before it started leaves a trace that is whole") {
  run::TemporaryFolder folder;
  const std::string path = folder / "a.trace";
  auto writer = TraceWriter::create(path, sample_header());
  REQUIRE(writer.ok());
  std::vector<MetricValue> metrics;
  for (const auto& metric : sample_header().metrics)
    metrics.push_back({metric.name, metric.is_bool, 0});
  const auto hash = (*writer)->finish({0, metrics, "world: an object fell off the table"});
  REQUIRE(hash.ok());
  const auto trace = read_trace(path);
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  CHECK_FALSE(trace->start.has_value());
  CHECK(trace->steps.empty());
  CHECK(trace->end->invalid == "world: an object fell off the table");
  CHECK(trace->hash == *hash);
  // Without a reason it is no such episode.
  auto forged = TraceWriter::create(path, sample_header());
  REQUIRE((*forged)->finish({0, metrics, std::nullopt}).ok());
  CHECK(read_trace(path).failure().message.starts_with("a valid end without a settled start"));
}

TEST_CASE("a full disk is told") {
  const auto hash = write_sample_trace("/dev/full", 3);
  REQUIRE_FALSE(hash.ok());
  CHECK(hash.failure().code == Fault::kStore);
  CHECK(hash.failure().message == "cannot be written: No space left on device");
}

TEST_CASE("a repeated episode names the first thing that differs") {
  TemporaryFolder folder;
  REQUIRE(write_sample_trace(folder / "a.trace", 2).ok());
  const auto trace = read_trace(folder / "a.trace");
  TraceComparer comparer(*trace);
  CHECK(comparer.start(sample_start()).ok());
  TraceStep step = sample_step(1);
  step.q[0] = std::nextafter(step.q[0], 2);
  step.sample.tcp.x() = 7;
  CHECK(comparer.step(step).ok());
  CHECK(comparer.difference() == "step 1: q of `waist` is 1.5000000000000002, recorded 1.5");
  CHECK(comparer.step(sample_step(1)).ok());
  CHECK(comparer.difference().starts_with("step 1:"));
}

}  // namespace
}  // namespace probe::store
