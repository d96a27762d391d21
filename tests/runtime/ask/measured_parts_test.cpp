// Questions about drawers and doors: who is asked has to see what is asked about.
#include "runtime/ask/measured_parts.h"

#include <doctest/doctest.h>

#include "runtime/ask/truth.h"
#include "tests/runtime/run/plan_of_text.h"

namespace probe::ask {
namespace {

const plan::Plan& drawer_plan() {
  static const plan::Plan plan = run::plan_of_text(R"(use "examples/drawer.probe"
questions about {
  yesno shut "Is the top drawer closed?" answer closed(cabinet.top_drawer)
  yesno ajar "Has the top drawer been pulled?" answer slide(cabinet.top_drawer) > 2cm
  yesno put  "Is {the source} in the top drawer?" answer lies_in(source, cabinet.inside_top)
  yesno off  "Is {the source} on {the target}?" answer distance_xy(source, target) < 5cm
}
suite mine { tasks { open_drawer }; seeds 42; questions about }
)");
  return plan;
}

std::uint32_t body_of(const plan::Plan& plan, std::string_view name) {
  const auto bodies = plan.bodies(plan.tasks()[plan.find_task("open_drawer").value()]);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (plan.text(bodies[i].name) == name) return i;
  }
  REQUIRE_MESSAGE(false, "no body is called ", std::string(name));
  return 0;
}

// `pixels` of each of the bodies, a row each.
View shown(const std::vector<std::pair<std::uint32_t, int>>& bodies) {
  constexpr std::size_t kSide = 100;
  View view{static_cast<int>(kSide), static_cast<int>(kSide),
            std::vector<std::uint8_t>(3 * kSide * kSide), std::vector<float>(kSide * kSide, 1.0F),
            std::vector<std::uint16_t>(kSide * kSide)};
  std::size_t row = 0;
  for (const auto& [body, pixels] : bodies) {
    for (int i = 0; i < pixels; ++i)
      view.segmentation[kSide * row + static_cast<std::size_t>(i)] =
          static_cast<std::uint16_t>(body + 1);
    ++row;
  }
  return view;
}

TEST_CASE("a drawer that is asked about shows as many pixels as what is named") {
  const plan::Plan& plan = drawer_plan();
  REQUIRE(plan.questions().size() == 4);
  const std::uint32_t drawer = body_of(plan, "cabinet.top_drawer");
  const std::uint32_t carrot = body_of(plan, "carrot"), plate = body_of(plan, "plate");
  const auto left_out = [&](std::size_t question, int pixels) {
    const View view = shown({{carrot, 80}, {plate, 80}, {drawer, pixels}});
    return find_truth(plan, plan.questions()[question], view, {}, true).left_out;
  };
  for (const std::size_t question : {0U, 1U, 2U}) {
    CAPTURE(question);
    CHECK(left_out(question, 64) == "");
    CHECK(left_out(question, 63) == "hidden: `top drawer` shows 63 of 64 pixels");
    CHECK(left_out(question, 0) == "hidden: `top drawer` shows 0 of 64 pixels");
  }
  CHECK(left_out(3, 0) == "");  // asks about no part
}

TEST_CASE("what a question measures of fixtures is found in its program") {
  const plan::Plan& plan = drawer_plan();
  const auto parts = measured_parts(plan, plan.questions()[0]);
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].name == "top drawer");
  CHECK(parts[0].bodies == std::vector{body_of(plan, "cabinet.top_drawer")});
  CHECK(measured_parts(plan, plan.questions()[2]).size() == 1);
  CHECK(measured_parts(plan, plan.questions()[3]).empty());
}

}  // namespace
}  // namespace probe::ask
