// Any bytes as a plan: the verifier refuses or everything behind it works on what it accepts:
// accessors, ids, disassembler, judge. Hashes stop almost all random bytes, so half of the runs
// seal the mutated bytes first, as a forger would.
// links: probe_plan probe_vm
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "runtime/plan/dis.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/plan.h"
#include "runtime/vm/judge.h"
#include "tests/plan/rule_of.h"
#include "tests/plan/seal.h"

namespace {

using namespace probe;
using test::Bytes;

void need(bool truth) {
  if (!truth) std::abort();
}

void judge(const plan::Plan& plan, std::uint32_t task) {
  const std::size_t bodies = plan.bodies(plan.tasks()[task]).size();
  vm::Judge judge(plan, task);
  std::vector<vm::BodyStart> starts(bodies);
  for (std::size_t i = 0; i < bodies; ++i) starts[i].half = {0.1, 0.2, 0.01};
  need(judge.begin(starts).ok());
  vm::StepSample sample;
  sample.bodies.resize(bodies);
  for (int step = 1; step <= 3; ++step) {
    sample.step = step;
    sample.bodies[0].position.x() = 0.01 * step;
    sample.contacts = {{0, 1, {0, 0, 0.1}}};
    const Status status = judge.step(sample);
    // Only a metric that is not finite may end an episode here.
    need(status.ok() || status.failure().code == Fault::kJudge);
    for (const double value : judge.values()) need(std::isfinite(value));
  }
}

void use(const plan::Plan& plan) {
  plan::IdHasher ids(plan.tables());
  for (std::uint32_t t = 0; t < plan.tasks().size() && t < 8; ++t) {
    const plan::TaskRecord& task = plan.tasks()[t];
    judge(plan, t);
    need(!plan::disassemble(plan, t).empty());
    for (const plan::EpisodeRecord& e : plan.episodes(task)) {
      need(plan.placements(e).size() >= 2);
      ids.start_parts(task, e);
    }
  }
  need(!plan::disassemble(plan).empty());
}

void open(const Bytes& bytes, bool identity) {
  const auto plan = plan::Plan::from_bytes(bytes, {.identity = identity});
  if (plan.ok()) {
    use(*plan);
    return;
  }
  need(plan::rule_of(plan.failure()) != nullptr);
  need(!plan.failure().where.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  open(bytes, true);
  test::seal(bytes);
  open(bytes, false);
  return 0;
}
