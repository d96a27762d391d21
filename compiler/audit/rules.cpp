#include "compiler/audit/rules.h"

#include <algorithm>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/regions.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/claims.h"
#include "runtime/vm/derived_solution.h"
#include "runtime/vm/made_up.h"
#include "runtime/vm/placed_world.h"

namespace probe::audit {
namespace {

constexpr double kGap = 0.001;     // m: between two boxes side by side
constexpr double kHeldGap = 5e-4;  // m: between what is held and what is below
constexpr double kHighest = 0.1;   // m: of a fixture's ledge above the target's lower side
constexpr double kLedge = 0.01;    // m: from one height of it to the next

// Where the source's box is beside the target's, its thin side against the target's: as near as the
// two can be without standing in one another. At the target's height.
Vec3 beside(const vm::MadeUpWorld& world) {
  const Vec3 source = world.starts[world.source].half, target = world.starts[world.target].half;
  const double apart = std::min(source.x(), source.y()) + std::min(target.x(), target.y()) + kGap;
  const bool along_x = target.x() <= target.y();
  return world.sample.bodies[world.target].position +
         (along_x ? Vec3(apart, 0, 0) : Vec3(0, apart, 0));
}

// Whether the source may lie on the target, or in it: else it is not there that success wants it.
Result<bool> may_lie_there(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                           std::uint32_t start) {
  for (const auto relation : {plan::SkillRelation::kOn, plan::SkillRelation::kIn}) {
    vm::MadeUpWorld world = vm::make_up_world(plan, task, start);
    vm::put_at(plan, plan.tasks()[task], world.source, {world.target, plan::kNone, relation}, 0,
               &world);
    vm::put_contacts_in_order(&world);
    PROBE_ASSIGN(const bool holds, vm::judge_world(plan, task, success, std::move(world)));
    if (holds) return true;
  }
  return false;
}

// Rules about one thing that goes to another are asked of no other task.
bool has_both(const plan::Plan& plan, std::uint32_t task) {
  return plan::roles_of(plan.tables(), plan.tasks()[task]).has_both();
}

// The first kind of start of which `asks` says that the metric is true after something was done.
// What is so before is not so because of it: things are not where they begin here, as in a drawer.
template <typename Ask>
Result<BrokenIn> first_start(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric,
                             Ask asks) {
  for (const std::uint32_t start : vm::kinds_of_starts(plan, task)) {
    PROBE_ASSIGN(const bool is_so_anyway,
                 vm::judge_world(plan, task, metric, vm::make_up_world(plan, task, start)));
    if (is_so_anyway) continue;
    PROBE_ASSIGN(const bool is_so, asks(start));
    if (is_so) return BrokenIn(start);
  }
  return BrokenIn();
}

}  // namespace

Result<BrokenIn> wrong_counts_target(const plan::Plan& plan, std::uint32_t task,
                                     std::uint32_t wrong) {
  if (!has_both(plan, task)) return BrokenIn();
  return first_start(plan, task, wrong, [&](std::uint32_t start) -> Result<bool> {
    vm::MadeUpWorld world = vm::make_up_world(plan, task, start);
    world.put(world.target, world.sample.bodies[world.target].position + Vec3(0.1, 0, 0));
    return vm::judge_world(plan, task, wrong, std::move(world));
  });
}

Result<BrokenIn> passes_beside(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  if (!has_both(plan, task)) return BrokenIn();
  if (plan.scenes()[plan.tasks()[task].scene].fixture_collision != plan::kNone) return BrokenIn();
  return first_start(plan, task, success, [&](std::uint32_t start) -> Result<bool> {
    vm::MadeUpWorld world = vm::make_up_world(plan, task, start);
    Vec3 at = beside(world);
    at.z() = world.sample.bodies[world.source].position.z();
    world.put(world.source, at);
    for (const std::uint16_t body : {world.source, world.target})
      world.press_down(body, world.surface);
    PROBE_ASSIGN(const bool holds, vm::judge_world(plan, task, success, std::move(world)));
    return holds ? may_lie_there(plan, task, success, start) : Result<bool>(false);
  });
}

Result<BrokenIn> passes_on_fixture(const plan::Plan& plan, std::uint32_t task,
                                   std::uint32_t success) {
  if (!has_both(plan, task)) return BrokenIn();
  if (plan.scenes()[plan.tasks()[task].scene].fixture_collision == plan::kNone) return BrokenIn();
  return first_start(plan, task, success, [&](std::uint32_t start) -> Result<bool> {
    for (double height = 0; height <= kHighest; height += kLedge) {
      vm::MadeUpWorld world = vm::make_up_world(plan, task, start);
      Vec3 at = beside(world);
      at.z() += height - world.starts[world.target].half.z() + world.starts[world.source].half.z();
      world.put(world.source, at);
      for (const std::uint16_t body : {world.source, world.target})
        world.press_down(body, world.fixture);
      PROBE_ASSIGN(const bool passes, vm::judge_world(plan, task, success, std::move(world)));
      if (passes) return true;
    }
    return false;
  });
}

namespace {

// Where a thing is held: above the target; of a target with a region of its own, in that, too.
std::vector<Vec3> held_at(const plan::Plan& plan, const plan::TaskRecord& task,
                          const vm::MadeUpWorld& world) {
  const Vec3& to = world.sample.bodies[world.target].position;
  const double above =
      world.starts[world.source].half.z() + world.starts[world.target].half.z() + kHeldGap;
  std::vector<Vec3> places = {to + Vec3(0, 0, above)};
  for (std::uint32_t r = 0; r < plan.regions().size(); ++r) {
    if (plan::owner_of(plan.tables(), task, plan.regions()[r]) != world.target) continue;
    places.push_back(world.sample.bodies[world.target].origin +
                     to_vec(plan::box_of(plan.tables(), r).middle));
  }
  return places;
}

}  // namespace

Result<BrokenIn> passes_held(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  if (!has_both(plan, task)) return BrokenIn();
  return first_start(plan, task, success, [&](std::uint32_t start) -> Result<bool> {
    const vm::MadeUpWorld still = vm::make_up_world(plan, task, start);
    for (const Vec3& place : held_at(plan, plan.tasks()[task], still)) {
      vm::MadeUpWorld world = still;
      world.put(world.source, place);
      world.hold_source();
      PROBE_ASSIGN(const bool passes, vm::judge_world(plan, task, success, std::move(world)));
      if (passes) return true;
    }
    return false;
  });
}

namespace {

struct PutThing {
  std::uint16_t object = 0;
  vm::PutPlace place;
};

// How one of several things is, instead of as it should be.
enum class Amiss : std::uint8_t { kNothing, kBeside, kHeld };

// Worlds one after the other, the first with nothing put, the last with all, one of them amiss;
// `place`: which of held_at.
std::vector<vm::MadeUpWorld> worlds_of(const plan::Plan& plan, std::uint32_t task,
                                       const vm::MadeUpWorld& still, std::span<const PutThing> puts,
                                       std::size_t odd, Amiss amiss, std::size_t place = 0) {
  std::vector<vm::MadeUpWorld> worlds = {still};
  for (std::size_t count = 1; count <= puts.size(); ++count) {
    vm::MadeUpWorld world = worlds.front();
    for (std::size_t i = 0; i < count; ++i) {
      if (i == odd && amiss != Amiss::kNothing) continue;
      vm::put_at(plan, plan.tasks()[task], puts[i].object, puts[i].place, i, &world);
    }
    if (odd < count && amiss != Amiss::kNothing) {
      world.source = puts[odd].object;
      world.target = static_cast<std::uint16_t>(puts[odd].place.to);
      if (amiss == Amiss::kBeside) {
        Vec3 at = beside(world);
        at.z() = world.sample.bodies[world.source].position.z();
        world.put(world.source, at);
        for (const std::uint16_t body : {world.source, world.target})
          world.press_down(body, world.surface);
      } else {
        const std::vector<Vec3> places = held_at(plan, plan.tasks()[task], world);
        world.put(world.source, places[place]);
        world.hold_source();
      }
    }
    vm::put_contacts_in_order(&world);
    worlds.push_back(std::move(world));
  }
  return worlds;
}

// Of one kind of start.
Status try_several(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                   std::uint32_t start, SeveralPut* found) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const std::uint32_t objects = plan::roles_of(plan.tables(), record).objects;
  const vm::MadeUpWorld still = vm::make_up_world(plan, task, start);
  PROBE_ASSIGN(const bool is_so_anyway, vm::judge_world(plan, task, success, still));
  if (is_so_anyway) return {};
  const auto said = plan::skills_of(plan.tables(), task);
  std::vector<plan::SkillRecord> skills(said.begin(), said.end());
  if (skills.empty()) {
    PROBE_ASSIGN(skills, vm::derive_solution(plan, task, start));
  }
  std::vector<PutThing> puts;
  bool is_plain = !skills.empty();
  for (const plan::SkillRecord& skill : skills) {
    const bool is_put = static_cast<plan::Skill>(skill.skill) == plan::Skill::kPut;
    is_plain = is_plain && is_put && skill.region == plan::kNone && skill.to < objects;
    if (is_put)
      puts.push_back({static_cast<std::uint16_t>(skill.body),
                      {skill.to, skill.region, static_cast<plan::SkillRelation>(skill.relation)}});
  }
  if (!skills.empty() && puts.size() < 2) return {};
  bool is_known = is_plain;
  if (is_plain) {
    PROBE_ASSIGN(is_known,
                 vm::judge_worlds(plan, task, success,
                                  worlds_of(plan, task, still, puts, 0, Amiss::kNothing)));
  }
  if (!is_known) {
    found->is_tried = false;
    return {};
  }
  const bool on_surface = plan.scenes()[record.scene].fixture_collision == plan::kNone;
  for (std::size_t i = 0; i < puts.size(); ++i) {
    if (!found->beside && on_surface && puts[i].place.relation != plan::SkillRelation::kBeside) {
      PROBE_ASSIGN(const bool beside,
                   vm::judge_worlds(plan, task, success,
                                    worlds_of(plan, task, still, puts, i, Amiss::kBeside)));
      if (beside) found->beside = start;
    }
    vm::MadeUpWorld about = still;
    about.source = puts[i].object;
    about.target = static_cast<std::uint16_t>(puts[i].place.to);
    const std::size_t places = held_at(plan, record, about).size();
    for (std::size_t place = 0; place < places && !found->held; ++place) {
      PROBE_ASSIGN(const bool held,
                   vm::judge_worlds(plan, task, success,
                                    worlds_of(plan, task, still, puts, i, Amiss::kHeld, place)));
      if (held) found->held = start;
    }
  }
  return {};
}

}  // namespace

Result<SeveralPut> passes_of_several(const plan::Plan& plan, std::uint32_t task,
                                     std::uint32_t success) {
  SeveralPut found;
  const plan::TaskRecord& record = plan.tasks()[task];
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), record);
  std::size_t movable = 0;
  for (std::uint32_t o = 0; o < roles.objects; ++o) {
    const bool has_role = !plan::role_of_body(plan.tables(), roles, o).empty();
    movable += has_role && o != roles.target && !roles.is_distractor(o);
  }
  if (movable < 2 || plan.episodes(record).empty()) return found;
  for (const std::uint32_t start : vm::kinds_of_starts(plan, task))
    PROBE_TRY(try_several(plan, task, success, start, &found));
  return found;
}

Result<bool> holds_at_start(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                            FixtureStarts& fixtures) {
  const auto code = plan.code(plan.programs()[plan.tasks()[task].program]);
  const bool reads_joints = std::ranges::any_of(code, [](const plan::Instruction& in) {
    const auto op = static_cast<plan::Op>(in.op);
    return op == plan::Op::kSLIDE || op == plan::Op::kTURN;
  });
  if (reads_joints) {
    for (const std::uint32_t start : vm::kinds_of_starts(plan, task)) {
      PROBE_ASSIGN(const bool holds,
                   vm::judge_world(plan, task, success, vm::make_up_world(plan, task, start)));
      if (holds) return true;
    }
  }
  const auto starts = static_cast<std::uint32_t>(plan.episodes(plan.tasks()[task]).size());
  for (std::uint32_t start = 0; start < starts; ++start) {
    const std::vector<vm::BegunIn> in = fixtures.of(task, start);
    for (const vm::Lies lies : {vm::Lies::kOn, vm::Lies::kIn}) {
      auto begun = vm::make_up_start(plan, task, start, lies, in);
      if (!begun) break;
      // What an episode would be invalid for is no way to begin: on a plate is not in it.
      PROBE_ASSIGN(const auto claims, vm::judge_claims(plan, task, begun->starts, begun->sample));
      if (!std::ranges::all_of(claims, &vm::ClaimVerdict::holds)) continue;
      PROBE_ASSIGN(const bool holds, vm::judge_world(plan, task, success, *std::move(begun)));
      if (holds) return true;
    }
  }
  return false;
}

Result<BrokenIn> passes_in_the_air(const plan::Plan& plan, std::uint32_t task,
                                   std::uint32_t success) {
  constexpr double kAbove = 0.3;  // m
  const auto roles = plan::roles_of(plan.tables(), plan.tasks()[task]);
  if (!roles.has_source() || roles.has_both()) return BrokenIn();
  return first_start(plan, task, success, [&](std::uint32_t start) -> Result<bool> {
    vm::MadeUpWorld world = vm::make_up_world(plan, task, start);
    world.put(world.source, world.sample.bodies[world.source].position + Vec3(0, 0, kAbove));
    return vm::judge_world(plan, task, success, std::move(world));
  });
}

bool counts_an_earlier_touch(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  std::vector<plan::Instruction> defining;  // by register
  std::vector<std::pair<std::uint16_t, bool>> open;
  for (const plan::Instruction& in : plan.code(plan.programs()[plan.tasks()[task].program])) {
    const plan::OpInfo& op = *plan::find_op(in.op);
    if (op.result != plan::Kind::kUnused) defining.push_back(in);
    if (op.b == plan::Kind::kMetric && in.b == success) open.emplace_back(in.a, false);
  }
  while (!open.empty()) {
    const auto [at, once] = open.back();
    open.pop_back();
    const plan::Instruction& in = defining[at];
    const plan::OpInfo& op = *plan::find_op(in.op);
    if (once && op.op == plan::Op::kIMP) return true;
    // What was so once of other things too (lifted, and touched) is a history of its own; only a
    // touch by itself is meant.
    const bool compares = op.op == plan::Op::kLT || op.op == plan::Op::kLE;
    if (once && !compares) continue;
    const bool below = op.op == plan::Op::kONCE;
    const auto follow = [&](plan::Kind kind, std::uint16_t operand) {
      if (kind == plan::Kind::kBool || kind == plan::Kind::kReal || kind == plan::Kind::kVector)
        open.emplace_back(operand, below || once);
    };
    follow(op.a, in.a);
    follow(op.b, in.b);
  }
  return false;
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
  const std::size_t fingers = plan::finger_count(plan.robots()[plan.scenes()[record.scene].robot]);
  const auto is_finger = [&](std::uint16_t body) {
    return static_cast<plan::BodyKind>(bodies[body].kind) == plan::BodyKind::kLink &&
           bodies[body].index < fingers;
  };
  while (!open.empty()) {
    const auto [at, held] = open.back();
    open.pop_back();
    const plan::Instruction& in = defining[at];
    const plan::OpInfo& op = *plan::find_op(in.op);
    const plan::ReadoutInfo* readout = plan::readout_of(op.op);
    // Nothing has to hold at the end of what an earlier step can decide.
    if (readout != nullptr && readout->keeps == plan::Keeps::kEarlier) continue;
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
