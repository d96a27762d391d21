// The suite's own metrics, and those of every scoring rule, against the naive evaluator.
#include <doctest/doctest.h>

#include <bit>
#include <set>
#include <tuple>

#include "compiler/emit/compile.h"
#include "runtime/vm/judge.h"
#include "tests/runtime/vm/random_judge.h"
#include "tests/runtime/vm/reference.h"

namespace probe::vm {

TEST_CASE("a handful of programs serve the suite's tasks, and none computes a thing twice") {
  const std::string files[] = {VLAPROBE_SOURCE_DIR "/suite/intact.probe"};
  auto compiled = build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets", .suite = ""});
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  REQUIRE(compiled->ok);
  const auto opened = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE(opened.ok());
  const plan::Plan& plan = *opened;
  std::set<std::uint32_t> used;
  for (const plan::TaskRecord& task : plan.tasks()) used.insert(task.program);
  std::size_t instructions = 0;
  for (const plan::ProgramRecord& program : plan.programs()) {
    std::set<std::tuple<int, int, int, int>> seen;
    for (const plan::Instruction& in : plan.code(program)) {
      const plan::OpInfo& info = *plan::find_op(in.op);
      if (info.result == plan::Kind::kUnused) continue;
      // Two monitors are the same when they remember the same thing of the same register.
      const bool remembers = info.is_monitor();
      const int n = remembers ? plan.states(program)[in.b].n : 0;
      CHECK_MESSAGE(seen.emplace(in.op, in.a, remembers ? 0 : in.b, n).second, info.name);
    }
    instructions = std::max<std::size_t>(instructions, program.code.count);
  }
  MESSAGE(plan.tasks().size() << " tasks, " << plan.programs().size() << " programs of at most "
                              << instructions << " instructions");
  CHECK(used.size() == plan.programs().size());
  CHECK(plan.tasks().size() == 51);
  CHECK(plan.programs().size() <= 9);
}

TEST_CASE("judge and naive evaluator agree on every program of the suite and its scoring rules") {
  const std::string files[] = {VLAPROBE_SOURCE_DIR "/suite/semantics.probe"};
  auto compiled = build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets", .suite = ""});
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  REQUIRE(compiled->ok);
  auto opened = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE(opened.ok());
  const plan::Plan& plan = *opened;
  std::set<std::uint32_t> seen;
  std::size_t values = 0, truths = 0;
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
    const plan::TaskRecord& task = plan.tasks()[t];
    if (!seen.insert(task.program).second) continue;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      // From worlds the size of a table's to ones where everything is in contact range.
      const double scale = seed % 4 == 0 ? 1.0 : seed % 4 == 1 ? 0.1 : seed % 4 == 2 ? 0.03 : 0.01;
      RandomWorld world(seed, task.bodies.count, scale);
      const auto starts = world.starts();
      Judge judge(plan, t);
      REQUIRE(judge.begin(starts).ok());
      std::vector<StepSample> history;
      for (int step = 1; step <= 7; ++step) {
        history.push_back(world.step(step));
        REQUIRE(judge.step(history.back()).ok());
        const Reference reference(plan, task, starts, history);
        for (std::uint16_t m = 0; m < judge.metric_count(); ++m) {
          const double want = reference.metric(m, history.size() - 1);
          REQUIRE(std::bit_cast<std::uint64_t>(judge.value(m)) ==
                  std::bit_cast<std::uint64_t>(want));
          truths += want != 0;
          ++values;
        }
      }
    }
  }
  MESSAGE(seen.size() << " programs, " << values << " values, " << truths << " of them true");
  CHECK(seen.size() >= 9);
  CHECK(truths > 0);
  CHECK(truths < values);
}

}  // namespace probe::vm
