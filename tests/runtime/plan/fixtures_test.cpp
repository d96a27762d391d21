// Fixtures with joints in a plan: what breaks their rules is refused, and what they are is in the
// ids.
#include "runtime/plan/fixtures.h"

#include <doctest/doctest.h>

#include "runtime/plan/dis.h"
#include "runtime/plan/plan.h"
#include "tests/plan/fixture_defects.h"

using namespace probe;
using namespace probe::plan;

namespace {

Plan made(Writer w = fixture_writer()) {
  auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : to_text(bytes.failure())));
  auto plan = Plan::from_bytes(std::move(*bytes));
  REQUIRE(plan.ok());
  return std::move(*plan);
}

}  // namespace

TEST_CASE("every defect of a fixture is refused at its section") {
  for (const Defect& defect : fixture_defects()) {
    Writer w = fixture_writer();
    std::ranges::reverse(w.records.spans);
    w.fill_ids();
    defect.make(w.records, w);
    const Status status = verify(w.lay_out());
    REQUIRE_MESSAGE(!status.ok(), defect.rule);
    CAPTURE(to_text(status.failure()));
    CHECK(status.failure().message.find(defect.rule) != std::string::npos);
    CHECK(status.failure().where.starts_with(defect.section));
  }
}

TEST_CASE("joints are counted and named over the fixtures of the scene") {
  const Plan plan = made();
  const SceneRecord& scene = plan.scenes()[0];
  CHECK(joint_names_of(plan.tables(), scene) ==
        std::vector<std::string>{"cabinet.top", "cabinet.wheel"});
  CHECK(joint_starts_of(plan.tables(), scene, plan.episodes(plan.tasks()[0])[0]) ==
        std::vector<double>{0, 9});
  const std::string listing = disassemble(plan, 0);
  CHECK(listing.find("SLIDE   r15   cabinet.top") != std::string::npos);
  CHECK(listing.find("LOCAL   r17   cabinet.top_drawer r0") != std::string::npos);
}

TEST_CASE("where joints begin is part of the start, whoever says it") {
  const auto start = [](const auto& change) {
    Writer w = fixture_writer();
    change(w.records, w);
    const Plan plan = made(std::move(w));
    return to_sha256(plan.episodes(plan.tasks()[0])[0].start_id);
  };
  const auto plain = start([](Records&, Writer&) {});
  CHECK(plain == start([](Records& r, Writer& w) {
          r.episodes[0].joints = w.reals(std::vector<double>{0, 9});
        }));
  const auto open = start([](Records& r, Writer& w) {
    r.episodes[0].joints = w.reals(std::vector<double>{0.1, 9});
  });
  CHECK(plain != open);
  CHECK(open == start([](Records& r, Writer&) { r.fixture_joints[0].start = 0.1; }));
  CHECK(plain != start([](Records& r, Writer&) { r.fixture_joints[0].friction = 3; }));
  CHECK(plain != start([](Records& r, Writer&) { r.fixtures[0].position[0] = 0; }));
  // Names are no part of what happens.
  CHECK(plain == start([](Records& r, Writer& w) { r.parts[1].text = w.text("upper drawer"); }));
}

TEST_CASE("a scene without fixtures with joints keeps its ids") {
  Writer with = fixture_writer(), without = small_writer();
  const Plan plan = made(std::move(without));
  CHECK(made(std::move(with)).episodes()[0].start_id != plan.episodes()[0].start_id);
  CHECK(plan.scenes()[0].fixtures.count == 0);
}
