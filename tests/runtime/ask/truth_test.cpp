// The right answer read off made-up pictures: who is left, nearer and where, and what is not asked.
#include "runtime/ask/truth.h"

#include <doctest/doctest.h>

#include <limits>

#include "tests/runtime/ask/asking_plan.h"

namespace probe::ask {
namespace {

constexpr std::uint32_t kCarrot = 0, kPlate = 1;  // bodies of asking_plan
enum Which : std::uint32_t { kSource, kThere, kMany, kLeft, kWhere, kRestate };

View empty_view(int width, int height) {
  const auto pixels = static_cast<std::size_t>(width * height);
  return {width, height, std::vector<std::uint8_t>(3 * pixels), std::vector<float>(pixels, 2.0F),
          std::vector<std::uint16_t>(pixels)};
}

// `pixels` of a body, a row of 10 below the other, from the left upper corner on.
void show(View& view, std::uint32_t body, int x, int y, int pixels, float depth = 1) {
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>((y + i / 10) * view.width + x + i % 10);
    view.segmentation[at] = static_cast<std::uint16_t>(body + 1);
    view.depth[at] = depth;
  }
}

void ask_nearer(plan::Writer& writer) {
  QuestionWriter q(writer);
  q.family("near", plan::QuestionForm::kYesNo);
  auto& near = q.question("Is the carrot nearer to the camera than the plate?",
                          plan::QuestionTruth::kNearerThan,
                          {{"carrot", kCarrot, true}, {"plate", kPlate, true}});
  near.a = 0;
  near.b = 1;
}

Truth truth_of(const plan::Plan& plan, std::uint32_t question, const View& view,
               const PictureRule& rule = {}) {
  return find_truth(plan, plan.questions()[question], view, rule);
}

TEST_CASE("what must be seen shows as many pixels as its family wants, or is not asked for") {
  const plan::Plan plan = asking_plan(1);
  View view = empty_view(100, 60);
  show(view, kPlate, 60, 10, 80);
  show(view, kCarrot, 10, 10, 63);
  CHECK(truth_of(plan, kSource, view).left_out == "hidden: `carrot` shows 63 of 64 pixels");
  CHECK(truth_of(plan, kWhere, view).left_out == "hidden: `carrot` shows 63 of 64 pixels");
  show(view, kCarrot, 10, 10, 64);
  CHECK(truth_of(plan, kSource, view).left_out.empty());
  CHECK(truth_of(plan, kSource, view).option == 0);
  CHECK(truth_of(plan, kMany, view).number == 1);
  // What is asked for may be missing.
  CHECK(truth_of(plan, kThere, empty_view(100, 60)).yes == false);
}

TEST_CASE("who is left is told by the middles, and not where they are too close") {
  const plan::Plan plan = asking_plan(1);
  const auto left = [&](int carrot, int plate) {
    View view = empty_view(100, 60);
    show(view, kCarrot, carrot, 10, 70);
    show(view, kPlate, plate, 30, 70);
    return truth_of(plan, kLeft, view);
  };
  CHECK(left(10, 60).yes == true);
  CHECK(left(60, 10).yes == false);
  CHECK(left(10, 12).yes == true);
  const Truth close = left(10, 11);  // 1 % of the width
  CHECK(!close.yes);
  CHECK(close.left_out ==
        "the middles of `carrot` and `plate` are too close to say which is further left");
}

TEST_CASE("who is nearer is told by the depths, and not where they are nearly equal") {
  const plan::Plan plan = asking_plan(1, ask_nearer);
  const auto nearer = [&](float carrot, float plate) {
    View view = empty_view(100, 60);
    show(view, kCarrot, 10, 10, 70, carrot);
    show(view, kPlate, 60, 10, 70, plate);
    return truth_of(plan, 0, view);
  };
  CHECK(nearer(0.5F, 0.6F).yes == true);
  CHECK(nearer(0.6F, 0.5F).yes == false);
  CHECK(nearer(0.51F, 0.5F).left_out.find("too equally far") != std::string::npos);
}

TEST_CASE("a point is right on a pixel that shows the thing, in the size that is sent") {
  const plan::Plan plan = asking_plan(1);
  View view = empty_view(100, 60);
  show(view, kCarrot, 20, 10, 100);
  show(view, kPlate, 60, 10, 100);
  const auto is_on = [](const Truth& truth, double x, double y) {
    Reading reading;
    reading.verdict = Verdict::kRead;
    reading.point = Reading::Point{x, y};
    return is_right(truth, reading);
  };
  const Truth truth = truth_of(plan, kWhere, view);
  REQUIRE(truth.area.has_value());
  CHECK(is_on(truth, 20, 10));
  CHECK(is_on(truth, 29.9, 19.9));
  CHECK_FALSE(is_on(truth, 30, 10));
  CHECK_FALSE(is_on(truth, 65, 12));  // the plate
  for (const double beyond : {-1.0, 1e300, std::numeric_limits<double>::quiet_NaN()})
    CHECK_FALSE(is_on(truth, beyond, 10));
  CHECK(is_on(truth, truth.area->inside.x, truth.area->inside.y));

  const Truth half = truth_of(plan, kWhere, view, {"", 50, 30});
  REQUIRE(half.area.has_value());
  CHECK(is_on(half, 12, 7));
  CHECK_FALSE(is_on(half, 22, 12));
  CHECK_FALSE(is_on(half, 12, 31));
}

TEST_CASE("what a crop leaves out is not asked for, and sides are those of what is left") {
  const plan::Plan plan = asking_plan(1);
  View view = empty_view(200, 60);
  show(view, kCarrot, 5, 10, 100);
  show(view, kPlate, 100, 10, 100);
  const PictureRule middle{"", 30, 30, servers::Resize::kCrop};
  CHECK(truth_of(plan, kLeft, view).yes == true);
  CHECK(truth_of(plan, kLeft, view, {"", 30, 30}).yes == true);
  for (const std::uint32_t question : {kSource, kLeft, kWhere}) {
    CAPTURE(question);
    CHECK(truth_of(plan, question, view, middle).left_out ==
          "hidden: `carrot` shows 0 of 64 pixels");
  }
  // Two pixels aside are 1 % of the whole width, and 3.3 % of the middle, which is 60 wide.
  View near = empty_view(200, 60);
  show(near, kCarrot, 90, 10, 100);
  show(near, kPlate, 92, 30, 100);
  CHECK(truth_of(plan, kLeft, near).left_out.find("too close") != std::string::npos);
  CHECK(truth_of(plan, kLeft, near, middle).yes == true);
}

}  // namespace
}  // namespace probe::ask
