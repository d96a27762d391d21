#include "compiler/audit/rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/plan/isa.h"
#include "runtime/vm/judge.h"

namespace probe::audit {
namespace {

constexpr int kSteps = 8;          // more than any published rule counts
constexpr double kContact = 0.01;  // N s: what a light object at rest presses in a substep
constexpr double kFar = 0.5;       // m: where objects stand that do not matter
constexpr double kGap = 0.001;     // m: between two boxes side by side
constexpr double kHeldGap = 5e-4;  // m: between what is held and what is below
constexpr double kHighest = 0.1;   // m: of a fixture's ledge above the target's lower side
constexpr double kLedge = 0.01;    // m: from one height of it to the next

// Half extents with z the axis that is nearest the vertical in the pose, as a world gives them.
Vec3 half_extents(const plan::ObjectRecord& object, const std::array<double, 4>& rotation) {
  std::array<double, 3> half{};
  for (std::size_t i = 0; i < 3; ++i) half[i] = (object.box_max[i] - object.box_min[i]) / 2;
  const auto& [w, x, y, z] = rotation;
  const std::array<double, 3> upright = {std::abs(2 * (x * z - w * y)),
                                         std::abs(2 * (y * z + w * x)),
                                         std::abs(1 - 2 * (x * x + y * y))};
  const auto up =
      static_cast<std::size_t>(std::max_element(upright.begin(), upright.end()) - upright.begin());
  return {half[up == 0 ? 2 : 0], half[up == 1 ? 2 : 1], half[up]};
}

// The task's bodies at rest, apart from one another and from the arm.
struct World {
  std::vector<vm::BodyStart> starts;
  vm::StepSample sample;
  std::uint16_t surface = 0, fixture = 0;
  std::vector<std::uint16_t> fingers;

  void put(std::size_t body, const Vec3& at) {
    sample.bodies[body].position = sample.bodies[body].origin = at;
  }
};

World at_rest(const plan::Plan& plan, const plan::TaskRecord& task) {
  const double table = plan.scenes()[task.scene].surface_z;
  const auto bodies = plan.bodies(task);
  const auto episodes = plan.episodes(task);
  World world;
  world.starts.resize(bodies.size());
  world.sample.bodies.resize(bodies.size());
  world.sample.tcp = {0, 0, table + kFar};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto kind = static_cast<plan::BodyKind>(bodies[i].kind);
    Vec3 at = {0, 0, table + kFar};
    if (kind == plan::BodyKind::kSurface) {
      world.surface = static_cast<std::uint16_t>(i);
      at = {0, 0, table};
    } else if (kind == plan::BodyKind::kObject) {
      std::array<double, 4> rotation = {1, 0, 0, 0};
      if (!episodes.empty()) rotation = plan.placements(episodes[0])[i].rotation;
      world.starts[i].half = half_extents(plan.objects()[bodies[i].index], rotation);
      at = {kFar * static_cast<double>(i), 0, table + world.starts[i].half.z()};
    } else if (kind == plan::BodyKind::kLink) {
      world.starts[i].opening = {0, 1, 0};
      if (bodies[i].index < 2) world.fingers.push_back(static_cast<std::uint16_t>(i));
    } else if (kind == plan::BodyKind::kFixture) {
      world.fixture = static_cast<std::uint16_t>(i);
    }
    world.starts[i].position = at;
    world.put(i, at);
  }
  return world;
}

// Where the source's box is beside the target's, its thin side against the target's: as near as the
// two can be without standing in one another. At the target's height.
Vec3 beside(const World& world) {
  const Vec3 source = world.starts[0].half, target = world.starts[1].half;
  const double apart = std::min(source.x(), source.y()) + std::min(target.x(), target.y()) + kGap;
  const bool along_x = target.x() <= target.y();
  return world.sample.bodies[1].position + (along_x ? Vec3(apart, 0, 0) : Vec3(0, apart, 0));
}

// What the metric says of a world that stays as it is.
Result<bool> judged(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric, World world) {
  vm::Judge judge(plan, task);
  PROBE_TRY(judge.begin(world.starts));
  for (int step = 1; step <= kSteps; ++step) {
    world.sample.step = step;
    world.sample.time = step / 5.0;
    PROBE_TRY(judge.step(world.sample));
  }
  return judge.truth(metric);
}

}  // namespace

Result<bool> wrong_counts_target(const plan::Plan& plan, std::uint32_t task, std::uint32_t wrong) {
  World world = at_rest(plan, plan.tasks()[task]);
  world.put(1, world.sample.bodies[1].position + Vec3(0.1, 0, 0));
  return judged(plan, task, wrong, std::move(world));
}

Result<bool> passes_beside(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  const plan::TaskRecord& record = plan.tasks()[task];
  if (plan.scenes()[record.scene].fixture_collision != plan::kNone) return false;
  World world = at_rest(plan, record);
  Vec3 at = beside(world);
  at.z() = world.sample.bodies[0].position.z();
  world.put(0, at);
  for (const std::uint16_t body : {std::uint16_t{0}, std::uint16_t{1}})
    world.sample.contacts.push_back({body, world.surface, {0, 0, -kContact}});
  return judged(plan, task, success, std::move(world));
}

Result<bool> passes_on_fixture(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  const plan::TaskRecord& record = plan.tasks()[task];
  if (plan.scenes()[record.scene].fixture_collision == plan::kNone) return false;
  for (double height = 0; height <= kHighest; height += kLedge) {
    World world = at_rest(plan, record);
    Vec3 at = beside(world);
    at.z() += height - world.starts[1].half.z() + world.starts[0].half.z();
    world.put(0, at);
    for (const std::uint16_t body : {std::uint16_t{0}, std::uint16_t{1}})
      world.sample.contacts.push_back({body, world.fixture, {0, 0, -kContact}});
    PROBE_ASSIGN(const bool passes, judged(plan, task, success, std::move(world)));
    if (passes) return true;
  }
  return false;
}

Result<bool> passes_held(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  World world = at_rest(plan, plan.tasks()[task]);
  const double above = world.starts[0].half.z() + world.starts[1].half.z() + kHeldGap;
  world.put(0, world.sample.bodies[1].position + Vec3(0, 0, above));
  world.sample.tcp = world.sample.bodies[0].position;
  for (const std::uint16_t finger : world.fingers)
    world.sample.contacts.push_back({0, finger, {0, kContact, 0}});
  return judged(plan, task, success, std::move(world));
}

bool ends_in_grasp(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const auto bodies = plan.bodies(record);
  std::vector<plan::Instruction> defining;           // by register
  std::vector<std::pair<std::uint16_t, bool>> open;  // what the metric depends on; below a `for`
  for (const plan::Instruction& in : plan.code(plan.programs()[record.program])) {
    const plan::OpInfo& op = *plan::find_op(in.op);
    if (op.result != plan::Kind::kUnused) defining.push_back(in);
    if (op.b == plan::Kind::kMetric && in.b == success) open.emplace_back(in.a, false);
  }
  const auto is_finger = [&](std::uint16_t body) {
    return static_cast<plan::BodyKind>(bodies[body].kind) == plan::BodyKind::kLink &&
           bodies[body].index < 2;
  };
  while (!open.empty()) {
    const auto [at, held] = open.back();
    open.pop_back();
    const plan::Instruction& in = defining[at];
    const plan::OpInfo& op = *plan::find_op(in.op);
    if (op.op == plan::Op::kONCE) continue;  // remembered: nothing has to hold at the end
    const bool touches = op.op == plan::Op::kIMP || op.op == plan::Op::kPUSH;
    if (held && touches && (is_finger(in.a) || is_finger(in.b))) return true;
    const bool below = held || op.op == plan::Op::kHOLD;
    const auto follow = [&](plan::Kind kind, std::uint16_t operand) {
      if (kind == plan::Kind::kBool || kind == plan::Kind::kReal || kind == plan::Kind::kVector)
        open.emplace_back(operand, below);
    };
    follow(op.a, in.a);
    follow(op.b, in.b);
  }
  return false;
}

}  // namespace probe::audit
