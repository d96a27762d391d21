// Predicates and metrics, judged over worlds made by hand. Each case begins with the productions it
// holds.
#include <doctest/doctest.h>

#include <numbers>

#include "runtime/base/upright.h"
#include "runtime/vm/judge.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

// The bodies of `red_on_tray`, in the order of the plan.
enum Body : std::uint16_t { kSource, kTarget, kSurface, kLeft, kRight, kBase, kWrist, kBodies };

// One control step: everything stands still where it settled, nothing touches.
struct World {
  std::vector<vm::BodyStart> starts;
  vm::StepSample sample;

  World() : starts(kBodies) {
    sample.bodies.resize(kBodies);
    at(kSource, {0.3, 0.4, 0.9});
    at(kTarget, {0.3, 0.1, 0.85});
    at(kSurface, {0, 0, 0.8});
    for (std::uint16_t i = 0; i < kBodies; ++i) starts[i].position = sample.bodies[i].position;
    starts[kSource].half = {0.02, 0.01, 0.01};
    starts[kTarget].half = {0.03, 0.04, 0.005};
    starts[kLeft].opening = {0, 1, 0};
    starts[kRight].opening = {0, -1, 0};
    sample.tcp = {0.3, 0.4, 1};
    sample.grip = 0.5;
  }
  void at(Body body, const Vec3& position) {
    sample.bodies[body].position = sample.bodies[body].origin = position;
  }
  // `a` pushes `b`, a < b.
  World& touch(Body a, Body b, const Vec3& push) {
    sample.contacts.push_back({a, b, push});
    return *this;
  }
};

// The values of metrics `m0`, `m1` ... of a text, step by step through `worlds`; after the last
// one.
std::vector<double> judged(const std::vector<std::string>& readouts, std::vector<World> worlds,
                           const std::string& more = "") {
  std::string text = more + "\nmetrics probe like plain {\n";
  for (std::size_t i = 0; i < readouts.size(); ++i)
    text += "m" + std::to_string(i) + " = " + readouts[i] + "\n";
  const Built built(text + "}\nvariant v of red_on_tray { metrics probe }\n");
  vm::Judge judge(built.plan(), built.index("v"));
  REQUIRE(judge.begin(worlds[0].starts).ok());
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    worlds[i].sample.step = static_cast<double>(i + 1);
    worlds[i].sample.time = 0.2 * static_cast<double>(i + 1);
    const Status done = judge.step(worlds[i].sample);
    REQUIRE_MESSAGE(done.ok(), to_text(done.failure()));
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < readouts.size(); ++i)
    values.push_back(judge.value(*judge.find_metric("m" + std::to_string(i))));
  return values;
}

void check_values(const std::vector<std::pair<std::string, double>>& wanted, const World& world,
                  const std::string& more = "") {
  std::vector<std::string> readouts;
  for (const auto& [text, value] : wanted) readouts.push_back(text);
  const auto found = judged(readouts, {world}, more);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    CHECK_MESSAGE(found[i] == doctest::Approx(wanted[i].second).epsilon(1e-12), wanted[i].first);
}

// The source stands at these heights (m), one a control step.
std::vector<World> heights(const std::vector<double>& list) {
  std::vector<World> worlds;
  for (const double height : list) {
    worlds.emplace_back();
    worlds.back().at(kSource, {0.3, 0.4, height});
  }
  return worlds;
}

}  // namespace

TEST_CASE("e_sum, e_mul, e_un: numbers with dimensions, in the usual order") {
  check_values({{"final height(source) + height(target) * 2 - 10cm", 0.9 + 1.7 - 0.1},
                {"final (height(source) + height(target)) * 2", 3.5},
                {"final -height(source) * 2", -1.8},
                {"final 2 - grip - grip * 0.5", 1.25},
                {"final height(source) * (1 / 8)", 0.9 / 8},
                {"final height(position(source) - position(target) * 2)", 0.9 - 1.7},
                {"final height(source) + 1m / 4", 1.15},
                {"final max(height(source), height(target)) - min(1m, 2m)", -0.1},
                {"final abs(height(target) - height(source))", 0.05}},
               World());
}

TEST_CASE("e_mul: the judge has no division, but constants are divided when compiled") {
  const auto a = [](const char* expr) {
    const std::string file = std::string("metrics m like plain { x = final ") + expr +
                             " }\nvariant v of red_on_tray { metrics m }\n";
    return failed_build(file);
  };
  CHECK(a("grip / step").find("the judge has no division") != std::string::npos);
  check_values({{"final height(source) + 3m / 4", 1.65}}, World());
}

TEST_CASE("e_cmp: six comparisons") {
  check_values({{"at end height(source) < 90.1cm", 1},
                {"at end height(source) <= 0.9m", 1},
                {"at end height(source) > 90cm", 0},
                {"at end height(source) >= 90cm", 1},
                {"at end step == 1", 1},
                {"at end step != 1", 0},
                {"at end angle(velocity(source), up) <= 60deg", 0},
                {"at end angle(velocity(source), up) > 90deg", 1}},
               [] {
                 World world;
                 world.sample.bodies[kSource].velocity = {0.5, 0, -0.1};
                 return world;
               }());
}

TEST_CASE("expr, e_and, e_not: `not` before `and` before `or`; blocks hold a condition a line") {
  const std::string yes = "height(source) > height(target)", no = "height(source) > 95cm",
                    other = "grip > 0.6";
  check_values({{"at end (" + yes + " or " + no + " and " + other + ")", 1},
                {"at end ((" + yes + " or " + no + ") and " + other + ")", 0},
                {"at end (not " + no + " and " + yes + ")", 1},
                {"at end not (" + no + " or " + yes + ")", 0},
                {"at end all {\n " + yes + "\n not " + no + "\n}", 1},
                {"at end all {\n " + yes + "\n " + no + "\n}", 0},
                {"at end any { " + no + "; " + yes + " }", 1},
                {"at end not any { " + no + "; " + other + " }", 1}},
               World());
}

TEST_CASE("readout, metric: what is kept of a signal over the steps") {
  // above 0.95 m at steps 2, 3 and 5 of 6
  const auto worlds = heights({0.9, 0.96, 0.97, 0.93, 0.99, 0.91});
  const std::string up = " height(source) > 95cm";
  const auto found =
      judged({"at end" + up, "once" + up, "always" + up, "count" + up, "first" + up,
              "first height(source) > 2m", "final height(source)", "max height(source)",
              "min height(source)", "always height(source) > 80cm"},
             worlds);
  const double wanted[] = {0, 1, 0, 3, 2, -1, 0.91, 0.99, 0.9, 1};
  for (std::size_t i = 0; i < std::size(wanted); ++i) {
    CAPTURE(i);
    CHECK(found[i] == wanted[i]);
  }
}

TEST_CASE("e_cmp, e_not: `for n steps` is true while the last n were; `once` and `always` latch") {
  const auto worlds = heights({0.9, 0.96, 0.97, 0.93, 0.99, 0.99});
  const std::string up = "height(source) > 95cm";
  CHECK(judged({"at end (" + up + " for 2 steps)", "at end (" + up + " for 3 steps)",
                "once (" + up + " for 3 steps)", "count (" + up + " for 2 steps)",
                "at end (once height(source) > 98cm and once height(source) < 92cm)",
                "count once height(source) > 96.5cm", "count always height(source) < 96.5cm",
                "at end (not once height(source) > 1m)"},
               worlds) == std::vector<double>{1, 0, 0, 2, 1, 4, 2, 1});
}

TEST_CASE("metrics: `like` keeps the order and replaces by name; a task may set one of its own") {
  const Built built(
      "metrics a { success = at end height(source) > 1m; top = max height(source) }\n"
      "metrics b like a { low = min height(source); success = once height(source) > 1m }\n"
      "variant v of red_on_tray { metrics b; set top = final height(source); set extra = count "
      "height(source) > 1m }\n");
  std::string names;
  for (const plan::MetricRecord& metric : built.plan().metrics(built.task("v"))) {
    names += std::string(built.plan().text(metric.name)) + ":" + std::to_string(metric.readout) +
             ":" + std::to_string(metric.type) + " ";
  }
  CHECK(names == "success:2:1 top:6:2 low:8:2 extra:4:2 ");
}

TEST_CASE("predicate, param, type: arguments by place and by name, defaults, any order of text") {
  const std::string more =
      "predicate near(a: body, b: object, gap: length = 2 * 10cm) = distance(a, b) < gap\n"
      "predicate slow(o: object, pace: number, span: time = 1s) = speed(o) * span < pace * 1cm\n"
      "predicate flat(o: object, tilt: angle) = angle(axis_z(o), up) <= tilt\n"
      "predicate hit(a: body, least: impulse) = impulse(a, source) >= least\n"
      "predicate gap(a: object, b: object) = distance_xy(a, b)\n";
  World world;
  world.touch(kSource, kSurface, {0, 0, -0.25});
  check_values({{"at end near(source, target)", 0},
                {"at end near(source, target, 31cm)", 1},
                {"at end near(gap: 31cm, b: target, a: source)", 1},
                {"at end near(surface, target, gap: 40cm)", 1},
                {"at end slow(source, 5)", 1},
                {"at end flat(source, 1deg)", 1},
                {"at end hit(surface, 0.2Ns)", 1},
                {"at end hit(surface, least: 0.3Ns)", 0},
                // A predicate may be a number.
                {"final gap(source, target) + 1m", 1.3}},
               world, more);
  CHECK(analyze_with_suite("predicate p(a: object) = q(a)\npredicate q(a: object) = p(a)\n")
            ->codes()
            .find("P0601") != std::string::npos);
}

TEST_CASE("relation: a predicate of places, coordinates and vectors of constants included") {
  const std::string more =
      "relation left_of(a: object, b: object, by: length = 2cm) \"left\" = y(a) > y(b) + by\n"
      "relation leftmost(a: object) \"left\" = all o in alike - {a}: left_of(a, o)\n";
  World world;
  check_values({{"at end left_of(target, source, by: -1m)", 1},
                {"final y(target) - y(source)", -0.3},
                {"final z(target) - z((1cm, 2cm, 3cm))", 0.82},
                {"final distance(target, (30cm, 10cm, 80cm)) + x(target)", 0.35},
                {"at end angle(axis_z(target), (0, 0, -2)) > 179deg", 1}},
               world, more);
  // A metric has no phrase whose rest others could fit.
  CHECK(analyze_with_suite(more + "metrics m like plain { x = at end leftmost(source) }\n"
                                  "variant v of red_on_tray { metrics m }")
            ->codes() == "");
}

TEST_CASE("arg: what a parameter does not take is said at the argument") {
  const std::string p = "predicate p(a: object, d: length = 1cm) = height(a) > d\n";
  const auto wrong = [&](const std::string& call) {
    const auto a = analyze_with_suite(p + "metrics m like plain { x = at end " + call +
                                      " }\nvariant v of red_on_tray { metrics m }");
    return a->codes() + " " + a->underlined();
  };
  CHECK(wrong("p(surface)") == "P0601 surface");
  CHECK(wrong("p(source, 3s)") == "P0302 3s");
  CHECK(wrong("p(source, e: 3cm)") == "P0201 e");
  CHECK(wrong("p()") == "P0601 p()");
  CHECK(wrong("p(source, 1cm, 2cm)") == "P0601 2cm");
}

TEST_CASE(
    "setexpr, set1: quantifiers over fingers, links, objects, others, bodies and their algebra") {
  World world;
  world.at(kSource, {0.4, 0.4, 0.9});  // moved 10 cm
  world.touch(kSource, kLeft, {0, 0.5, 0}).touch(kSource, kRight, {0.1, -0.5, 0});
  world.touch(kTarget, kSurface, {0, 0, -1});
  check_values(
      {{"at end all f in fingers: impulse(f, source) > 1e-6Ns", 1},
       {"at end all f in fingers: angle(opening(f), push(source, f)) <= 10deg", 0},
       {"at end any f in fingers: angle(opening(f), push(source, f)) <= 10deg", 1},
       {"at end any l in links - fingers: impulse(l, source) > 1e-6Ns", 0},
       {"at end no x in bodies - {source, target} - links: impulse(source, x) > 1e-6Ns", 1},
       {"at end no x in bodies - links: impulse(target, x) > 1e-6Ns", 0},
       {"at end all x in objects - {source}: moved_xy(x) < moved_xy(source)", 1},
       {"at end any x in others: moved_xy(x) > 1cm", 0},
       {"at end any x in objects | {surface}: height(x) < 81cm", 1},
       {"at end all x in objects & others: height(x) < 86cm", 1},
       {"at end any x in {source, target}: height(x) > 87cm", 1},
       {"at end all x in (objects | links) & objects: height(x) > 84cm", 1},
       {"at end no l in links: impulse(l, target) > 1e-6Ns", 1}},
      world);
}

TEST_CASE("e_un: every measure") {
  World world;
  vm::BodySample& source = world.sample.bodies[kSource];
  source.velocity = {0.3, 0.4, 0};
  source.spin = {0, 0, 2};
  source.rotation = Quat(Eigen::AngleAxisd(3.14159265358979323846 / 2, Vec3::UnitX()));
  source.origin = {0.31, 0.4, 0.9};
  world.at(kTarget, {0.3, 0.4, 0.85});
  world.touch(kSource, kTarget, {0, 0, -0.5});
  world.starts[kTarget].position = {0, 0, 0.85};
  check_values({{"final impulse(source, target)", 0.5},
                {"final impulse(target, source)", 0.5},
                {"at end angle(push(source, target), up) > 170deg", 1},
                {"at end angle(push(target, source), up) < 10deg", 1},
                {"final distance(tcp, source)", 0.1},
                {"final distance_xy(origin(source), target)", 0.01},
                {"final height(position(source))", 0.9},
                {"final height(start(target))", 0.85},
                {"at end angle(velocity(source), spin(source)) > 89deg", 1},
                {"final speed(source)", 0.5},
                {"final half_height(target)", 0.005},
                {"final half_diagonal(target)", 0.05},
                {"final x(half_size(target))", 0.03},
                {"final y(half_size(target))", 0.04},
                {"final z(half_size(target))", 0.005},
                {"final moved_xy(target)", 0.5},
                {"at end angle(axis_x(source), up) < 89deg", 0},
                {"at end angle(axis_y(source), up) < 1deg", 1},
                {"at end angle(axis_z(source), up) < 89deg", 0},
                {"final grip", 0.5},
                {"final step", 1},
                {"final time", 0.2},
                {"final latest(height(source), step <= 1)", 0.9},
                {"final latest(height(source), height(source) < 1cm)", 0.9},
                {"times height(source) > 1cm", 1},
                {"times height(source) < 1cm", 0}},
               world);
}

TEST_CASE("the library's inside has its middle between the walls, below the rim, off the ground") {
  const std::string library = places();
  const Vec3 push = {0, 0, 0.01};
  // A hollow thing 14 cm across and 4 cm tall, and a cube of 3 cm; `at` from the middle of its
  // foot.
  const auto says = [&](const char* what, const Vec3& at, bool is_grounded, double inside) {
    CAPTURE(what);
    World world;
    const Vec3 middle{0.3, 0.1, 0.82};
    world.at(kTarget, middle);
    world.at(kSource, middle + at - Vec3(0, 0, 0.02));
    world.starts[kTarget].half = {0.07, 0.07, 0.02};
    world.starts[kSource].half = {0.015, 0.015, 0.015};
    if (is_grounded) world.touch(kSource, kSurface, push);
    world.touch(kTarget, kSurface, push);
    check_values({{"at end inside(source, target)", inside}}, world, library);
  };
  says("on its floor", {0, 0, 0.019}, false, 1);
  says("in a corner", {0.045, -0.045, 0.019}, false, 1);
  says("tipped against a wall", {0.05, 0, 0.022}, false, 1);
  says("on another that lies there, its middle above the rim", {0, 0, 0.049}, false, 0);
  says("across the rim", {0, 0, 0.055}, false, 0);
  says("on a wall, half outside", {0.0675, 0, 0.055}, false, 0);
  says("on the rim from outside, its far end on the ground", {0.06, 0, 0.03}, true, 0);
  says("against a wall from outside", {0.085, 0, 0.015}, true, 0);
  says("against a wall from outside, on something else", {0.085, 0, 0.03}, false, 0);
  says("held over it", {0, 0, 0.1}, false, 0);
  says("below a thing without a floor", {0, 0, 0.015}, true, 0);
}

TEST_CASE("the library's inside takes the walls of an oblong thing in its own axes") {
  const std::string library = places();
  // 20 cm by 8 cm and 4 cm tall, its long axis turned 30 degrees from x; `along` and `across` it.
  const auto says = [&](const char* what, double along, double across, double inside) {
    CAPTURE(what);
    for (const Mat3& lying :
         {Mat3(Mat3::Identity()), Mat3(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX())),
          Mat3(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()))}) {
      World world;
      const Mat3 turn(Eigen::AngleAxisd(std::numbers::pi / 6, Vec3::UnitZ()));
      const Vec3 middle{0.3, 0.1, 0.82};
      world.at(kTarget, middle);
      world.sample.bodies[kTarget].rotation = Eigen::Quaterniond(Mat3(turn * lying));
      // Half extents along its own axes, as they lie in the world.
      const Vec3 own = (lying.transpose() * Vec3(0.1, 0.04, 0.02)).cwiseAbs();
      world.starts[kTarget].half = upright_half(own, turn * lying);
      world.at(kSource, middle + turn * Vec3(along, across, 0));
      world.starts[kSource].half = {0.01, 0.01, 0.01};
      world.touch(kTarget, kSurface, {0, 0, 0.01});
      check_values({{"at end inside(source, target)", inside}}, world, library);
    }
  };
  says("in the middle", 0, 0, 1);
  says("at its far end", 0.09, 0, 1);
  says("at a long wall", 0, 0.035, 1);
  says("beside a long wall, held there", 0, 0.05, 0);
  says("beside a short wall, held there", 0.11, 0, 0);
}

// `predicate` of the library's page of places, judged in worlds made by hand.
TEST_CASE("the library's beside is on the ground and on_top_of is not") {
  const std::string library = places();
  const auto says = [&](const World& world, double beside, double on_top_of) {
    check_values({{"at end beside(source, target)", beside},
                  {"at end on_top_of(source, target)", on_top_of}},
                 world, library);
  };
  const Vec3 push = {0, 0, 0.01};
  World on_it;  // lies on the target, which lies on the surface
  on_it.at(kSource, {0.3, 0.1, 0.865});
  on_it.touch(kSource, kTarget, push).touch(kTarget, kSurface, push);
  says(on_it, 0, 1);
  World next_to_it;  // higher than the low target, its centre within the target's diagonal
  next_to_it.at(kSource, {0.3, 0.148, 0.856});
  next_to_it.touch(kSource, kSurface, push).touch(kTarget, kSurface, push);
  says(next_to_it, 1, 0);
  World leaning = next_to_it;
  leaning.sample.contacts.insert(leaning.sample.contacts.begin(), {kSource, kTarget, push});
  says(leaning, 1, 0);
  World above = on_it;  // held over it
  above.sample.contacts = {{kTarget, kSurface, push}};
  says(above, 0, 0);
  World away = next_to_it;
  away.at(kSource, {0.3, 0.2, 0.856});
  says(away, 0, 0);
}
