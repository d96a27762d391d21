// What `show` and `diff` say of words that say where things are.
#include "runtime/inspect/claims_json.h"

#include <doctest/doctest.h>

#include "runtime/inspect/plan_diff.h"
#include "runtime/inspect/task_diff.h"
#include "runtime/inspect/task_json.h"
#include "runtime/plan/dis.h"
#include "tests/runtime/run/claims_plan.h"

namespace probe::inspect {
namespace {

TEST_CASE("a task is shown with what its words say of places, and listed with their program") {
  const plan::Plan& plan = run::claims_plan();
  const std::uint32_t task = plan.find_task("falls").value();
  const Json json = describe(plan, task);
  REQUIRE(json.contains("claims"));
  CHECK(claims_text(json["claims"]).dump() ==
        R"(["\"spoon left of the green cube\" is standing, not towel"])");
  CHECK(describe_text(json).find("claims       \"spoon left of the green cube\" is standing") !=
        std::string::npos);
  CHECK(plan::disassemble(plan, task).find("claim \"spoon left of the green cube\" is body 0 of") !=
        std::string::npos);
}

TEST_CASE("equal claims are no difference") {
  const plan::Plan& plan = run::claims_plan();
  const std::uint32_t falls = plan.find_task("falls").value();
  const std::uint32_t stays = plan.find_task("stays").value();
  CHECK(same_claims(plan, falls, plan, stays));
  CHECK(diff_text(diff_tasks(plan, stays, falls)).find("claims") != std::string::npos);
  CHECK(diff_plans(plan, plan)["equal"].get<std::size_t>() == 2);
}

}  // namespace
}  // namespace probe::inspect
