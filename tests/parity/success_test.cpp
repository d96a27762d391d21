// The rule of success of each task against the published one, written down here a second time from
// its description and asked about thousands of made-up worlds.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "runtime/vm/judge.h"
#include "tests/parity/published.h"

using namespace probe;

namespace {

constexpr int kSteps = 7;

// One control step of a made-up world: objects near their limits, contacts at random.
struct Arrangement {
  std::vector<vm::BodyStart> starts;
  std::vector<vm::StepSample> steps;
};

struct Bodies {
  std::size_t objects = 0;  // source, target, distractors
  std::vector<std::uint16_t> others, fingers;
};

Bodies bodies_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  Bodies out;
  const auto bodies = plan.bodies(task);
  for (std::uint16_t i = 0; i < bodies.size(); ++i) {
    const auto kind = static_cast<plan::BodyKind>(bodies[i].kind);
    if (kind == plan::BodyKind::kObject) ++out.objects;
    if (kind == plan::BodyKind::kLink && bodies[i].index < 2) out.fingers.push_back(i);
    if (kind != plan::BodyKind::kLink && i > 1) out.others.push_back(i);
  }
  return out;
}

class Worlds {
 public:
  explicit Worlds(std::uint64_t seed) : draw_(seed) {}

  Arrangement make(const plan::Plan& plan, const plan::TaskRecord& task) {
    const Bodies bodies = bodies_of(plan, task);
    Arrangement world;
    world.starts.resize(task.bodies.count);
    for (std::size_t i = 0; i < bodies.objects; ++i) {
      world.starts[i].half = {between(0.01, 0.06), between(0.01, 0.06), between(0.002, 0.03)};
      world.starts[i].position = {between(-0.3, 0.3), between(-0.3, 0.3), 0.9};
    }
    world.starts[bodies.fingers[0]].opening = {0, 1, 0};
    world.starts[bodies.fingers[1]].opening = {0, -1, 0};
    const bool holds_often = chance(2);  // five steps of a grasp in a row are rare by chance
    for (int step = 1; step <= kSteps; ++step) {
      vm::StepSample sample;
      sample.bodies.resize(task.bodies.count);
      for (std::size_t i = 0; i < bodies.objects; ++i) {
        const double far = chance(2) ? 0.02 : 0.06;
        sample.bodies[i].position =
            world.starts[i].position + Vec3(between(-far, far), between(-far, far), 0);
      }
      // The source about where the rule changes its mind: the rim, and the height of lying on it.
      const Vec3 &s = world.starts[0].half, &t = world.starts[1].half;
      const double rim = std::sqrt(t.x() * t.x() + t.y() * t.y());
      const double away = rim + pick({-0.01, -0.001, 0.001, 0.002, 0.004, 0.009, 0.011});
      const double angle = between(0, 6.28);
      const double up = pick({-t.z() - s.z(), -0.001, 0.0, 0.001, t.z() + s.z() - 0.002,
                              t.z() + s.z() + 0.0005, t.z() + s.z() + 0.0015, t.z() + s.z() + 0.019,
                              t.z() + s.z() + 0.021, t.z() + s.z() + 0.059, t.z() + s.z() + 0.061});
      if (chance(2)) {
        sample.bodies[1].position = world.starts[1].position;
        sample.bodies[0].position =
            sample.bodies[1].position + Vec3(away * std::cos(angle), away * std::sin(angle), up);
      }
      for (vm::BodySample& body : sample.bodies) body.origin = body.position;
      for (std::uint16_t body = 1; body < task.bodies.count; ++body) {
        const bool is_finger = body == bodies.fingers[0] || body == bodies.fingers[1];
        const double sign = body == bodies.fingers[1] ? -1 : 1;
        if (is_finger && (holds_often || chance(2))) {
          const double slant = pick({0.1, 1.7, 1.8});  // of the push; 60 degrees at 1.732
          sample.contacts.push_back({0, body, Vec3(holds_often ? 0.1 : slant, sign, 0) * 0.01});
        } else if (!is_finger && chance(4)) {
          sample.contacts.push_back({0, body, {0, 0, -pick({0.01, 5e-7})}});
        }
      }
      sample.step = step;
      world.steps.push_back(std::move(sample));
    }
    return world;
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(draw_);
  }
  bool chance(unsigned in) { return draw_() % in == 0; }
  double pick(std::initializer_list<double> values) {
    return values.begin()[draw_() % values.size()];
  }
  std::mt19937_64 draw_;
};

double level(const Vec3& a) { return std::sqrt(a.x() * a.x() + a.y() * a.y()); }

// The published rules, from their description.
struct PublishedRule {
  const Bodies& bodies;
  const Arrangement& world;

  const vm::StepSample& last() const { return world.steps.back(); }
  bool near(double slack) const {
    return level(last().bodies[0].position - last().bodies[1].position) <=
           level(world.starts[1].half) + slack;
  }
  double rise() const { return last().bodies[0].position.z() - last().bodies[1].position.z(); }
  bool low(double allowance) const {
    return rise() - world.starts[1].half.z() - world.starts[0].half.z() <= allowance;
  }
  bool clear() const {
    for (const vm::ContactSample& contact : last().contacts) {
      if (contact.push.norm() <= 1e-6) continue;
      for (const std::uint16_t other : bodies.others) {
        if (contact.a == 0 && contact.b == other) return false;
      }
    }
    return true;
  }
  bool grasped(const vm::StepSample& step) const {
    for (const std::uint16_t finger : bodies.fingers) {
      bool pinches = false;
      for (const vm::ContactSample& contact : step.contacts) {
        if (contact.a != 0 || contact.b != finger) continue;
        const Vec3& opening = world.starts[finger].opening;
        pinches = contact.push.norm() >= 1e-6 &&
                  std::acos(contact.push.dot(opening) / contact.push.norm()) <= std::acos(0.5);
      }
      if (!pinches) return false;
    }
    return true;
  }
  double moved(std::size_t object) const {
    return level(last().bodies[object].position - world.starts[object].position);
  }

  bool holds(const std::string& rule) const {
    const bool above = rise() > 0;
    if (rule == "on") return near(0.003) && above && low(0.02) && clear();
    if (rule == "on_no_contact_check") return near(0.003) && above && low(0.02);
    if (rule == "basket") return near(0.003) && above && low(0.06);
    if (rule == "on_or_in") return holds("on") || (near(0) && low(0.02));
    if (rule == "on_or_in_z1mm")
      return (near(0.003) && above && low(0.001) && clear()) || (near(0) && low(0.001));
    REQUIRE(rule == "moved_but_not_on");
    if (near(0.01) && above && low(0.02)) return false;
    if (moved(0) <= 0.03) return false;
    for (std::size_t other = 1; other < bodies.objects; ++other) {
      if (moved(other) >= moved(0)) return false;
    }
    for (int back = 0; back < 5; ++back) {
      if (!grasped(world.steps[world.steps.size() - 1 - static_cast<std::size_t>(back)]))
        return false;
    }
    return true;
  }
};

}  // namespace

TEST_CASE("the rule of success of every task agrees with the published one") {
  const test::Published* released = test::published();
  if (released == nullptr) return;
  const plan::Plan& plan = test::suite_plan();
  std::map<std::string, std::pair<std::size_t, std::size_t>> seen;  // by rule: true, false
  std::size_t tasks = 0;
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
    const plan::TaskRecord& task = plan.tasks()[t];
    const std::string name(plan.text(task.name));
    CAPTURE(name);
    const Json* entry = released->find(name);
    REQUIRE(entry != nullptr);
    const std::string rule = (*entry)["success"].text();
    CAPTURE(rule);
    const Bodies bodies = bodies_of(plan, task);
    const auto success = plan.find_metric(task, "success");
    REQUIRE(success.has_value());
    Worlds worlds(t);
    bool agrees = true;
    for (int i = 0; i < 2000; ++i) {
      const Arrangement world = worlds.make(plan, task);
      vm::Judge judge(plan, t);
      REQUIRE(judge.begin(world.starts).ok());
      for (const vm::StepSample& step : world.steps) REQUIRE(judge.step(step).ok());
      const bool want = PublishedRule{bodies, world}.holds(rule);
      agrees = agrees && judge.truth(*success) == want;
      ++(want ? seen[rule].first : seen[rule].second);
    }
    CHECK(agrees);
    ++tasks;
  }
  std::string counts;
  for (const auto& [rule, count] : seen) {
    CHECK(count.first > 0);
    CHECK(count.second > 0);
    counts += "\n  " + rule + ": true " + std::to_string(count.first) + ", false " +
              std::to_string(count.second);
  }
  MESSAGE(tasks << " tasks have the published rule of success; asked of made-up worlds:" << counts);
  CHECK(seen.size() == 6);
}
