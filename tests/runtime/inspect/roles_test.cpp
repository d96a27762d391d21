// Tasks with other roles than source and target, as `show`, `diff` and `draw` tell of them.
#include "runtime/inspect/task_diff.h"
#include "runtime/inspect/task_json.h"
#include "runtime/inspect/top_view.h"
#include "tests/runtime/inspect/small_plan.h"

using namespace probe;
using namespace probe::inspect;

namespace {

const plan::Plan& with_roles() {
  static const plan::Plan plan = test::compile_small(R"(
role helper
role goods: set
layout three like grid_24 { place source, target, helper in distinct corners; expect 48 episodes }
layout alone {
  cells corners = grid 2 x 2 at (-16cm, 0cm) spread (7.5cm, 7.5cm)
  place goods in distinct corners
  place plate at (-16cm, 0cm)
  orient by rest
  drop 50cm settle 0.5s
}
metrics helped like put_strict { both = at end (resting_on(source, target) and resting_on(helper, target)) }
metrics on_plate { success = at end (all g in goods: resting_on(g, plate)) }
task pair like on_table {
  source carrot; target plate; helper spoon; layout three; metrics helped
  say "put {the source} and {the helper} on {the target}"
}
variant pair_twig of pair { helper twig }
task several like on_table { goods carrot, twig; layout alone; metrics on_plate; say "put {both goods} on {the plate}" }
variant turned of several { goods twig, carrot }
)");
  return plan;
}

std::uint32_t task(const char* name) { return with_roles().find_task(name).value(); }

}  // namespace

TEST_CASE("a task is shown with what fills its roles, and with none where there is none") {
  const Json pair = describe(with_roles(), task("pair"));
  CHECK(pair["source"] == "carrot");
  CHECK(pair["roles"].dump() == R"({"helper":"spoon"})");
  CHECK(pair["distances_m"].size() == pair["starts"].size());
  CHECK(describe_text(pair).find("helper       spoon\n") != std::string::npos);
  const Json several = describe(with_roles(), task("several"));
  CHECK(several["source"].is_null());
  CHECK(several["target"].is_null());
  CHECK(several["roles"].dump() == R"({"goods":["carrot","twig"]})");
  CHECK(several["placed"].dump() == R"(["plate"])");
  CHECK(several["distances_m"].empty());
  const std::string text = describe_text(several);
  CHECK(text.find("source       none\n") != std::string::npos);
  CHECK(text.find("placed       plate\n") != std::string::npos);
  CHECK(text.find("apart") == std::string::npos);
}

TEST_CASE("another helper is an axis of its own name") {
  CHECK(describe(with_roles(), task("pair_twig"))["axes"].dump() == R"(["object.helper"])");
  const Json diff = diff_tasks(with_roles(), task("pair"), task("pair_twig"));
  CHECK(diff["axes"].dump() == R"(["object.helper"])");
  CHECK(diff["declared_axes"].dump() == R"(["object.helper"])");
  CHECK(diff_text(diff).find("* helper        spoon") != std::string::npos);
  const std::string other = diff_text(diff_tasks(with_roles(), task("pair"), task("several")));
  CHECK(other.find("* goods         none") != std::string::npos);
  CHECK(other.find("* source        carrot") != std::string::npos);
}

TEST_CASE("a set in another order is the axis of its role, as the compiler counts it") {
  CHECK(describe(with_roles(), task("turned"))["axes"].dump() == R"(["object.goods"])");
  const Json diff = diff_tasks(with_roles(), task("several"), task("turned"));
  CHECK(diff["axes"].dump() == R"(["object.goods"])");
  CHECK(diff["declared_axes"].dump() == R"(["object.goods"])");
}

TEST_CASE("the view from above knows who has which role") {
  const auto view = top_view(with_roles(), task("several"), test::asset_root());
  REQUIRE(view.ok());
  CHECK(view->sources.empty());
  REQUIRE(view->others.size() == 2);
  CHECK(view->others[0].role == "goods");
  CHECK(view->others[0].objects == std::vector<std::string>{"carrot", "twig"});
  CHECK(view->others[1].role.empty());
  CHECK(view->others[1].objects == std::vector<std::string>{"plate"});
}
