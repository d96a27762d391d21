// Worlds made up to ask a judge what it thinks of them: a task's bodies at rest, far apart, moved
// by hand. No physics; what is found does not depend on how a rule is written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/vm/sample.h"

namespace probe::vm {

// N s: what a light object at rest presses in a substep.
inline constexpr double kMadeUpContact = 0.01;

// Where things are made up to be: along +x and -y; the other way, parts of fixtures as low as the
// surface; or close about the target. What is true in the one and not in another is true because of
// that, as "left of", "higher than" and "far from" are, and says nothing of a real world.
enum class Spread : std::uint8_t { kAlong, kBack, kNear };
inline constexpr Spread kSpreads[] = {Spread::kAlong, Spread::kBack, Spread::kNear};

// The task's bodies as a start turns them and joints of fixtures as it has them; nothing touches.
// They are half a metre from one another and from the arm, parts of fixtures as well as objects;
// under kNear up to eight objects stand in a ring, a centimetre off the target (of a task without
// one off the source, or else its first object), and parts are over it, half a metre one above the
// other.
struct MadeUpWorld {
  Spread spread = Spread::kAlong;
  std::vector<BodyStart> starts;
  StepSample sample;
  std::uint16_t source = 0, target = 0;    // of tasks that have them
  std::uint16_t surface = 0, fixture = 0;  // the fixture 0 where the scene has none
  std::vector<std::uint16_t> fingers;      // each opens along +y
  std::vector<Vec3> middles;  // of the objects' boxes, from the model's origin; of others 0

  // A step in the plane, mirrored where the world is.
  Vec3 mirrored(const Vec3& by) const {
    return spread == Spread::kBack ? Vec3(-by.x(), -by.y(), by.z()) : by;
  }
  // Under kNear: where the source has moved to when it is on the ring's side that is kept free.
  Vec3 free_side() const;
  // `at`: the middle of its box. Its model's origin, which regions of its own count from, lies
  // where the model has it, as long as the object stands upright.
  void put(std::size_t body, const Vec3& at) {
    sample.bodies[body].position = at;
    sample.bodies[body].origin = at - middles[body];
  }
  // Body `a` presses `b`, a < b, straight down.
  void press_down(std::uint16_t a, std::uint16_t b) {
    sample.contacts.push_back({a, b, {0, 0, -kMadeUpContact}});
  }
  // Every finger is pressed open by the source.
  void hold_source() {
    for (const std::uint16_t finger : fingers)
      sample.contacts.push_back({source, finger, {0, kMadeUpContact, 0}});
    sample.tcp = sample.bodies[source].position;
  }
};

// `start`: of the task's episodes, which may be none.
MadeUpWorld make_up_world(const plan::Plan& plan, std::uint32_t task, std::uint32_t start = 0,
                          Spread spread = Spread::kAlong);

// What a start gives to its made-up world: starts of which it is the same have the same goal, and
// the same skills make success. `joint_step` (m, rad): what joints are rounded to; 0: not at all.
std::vector<double> begins_as(const plan::Plan& plan, std::uint32_t task, std::uint32_t start,
                              double joint_step = 0);
// The first start of each kind, ascending, joints rounded to a centimetre and half a degree:
// recorded ones differ by a hair. 0 of a task without starts.
std::vector<std::uint32_t> kinds_of_starts(const plan::Plan& plan, std::uint32_t task);

// How what a layout puts on another object comes to rest: its lower side on the other's upper side,
// or just above the other's lower side, as in a hollow thing.
enum class Lies : std::uint8_t { kOn, kIn };

// An object that begins in a fixture, or in a part of one: the middle of its box in that body's
// frame.
struct BegunIn {
  std::uint16_t object = 0, owner = 0;  // bodies of the task
  Vec3 at;
};

// The task's objects where a start places them, at rest: on one another where the layout puts them
// so, in fixtures where `in` says so, the others on the surface; everything presses what carries
// it. None when no object is put on another or in a fixture. Fixtures and their parts are as in
// make_up_world, and what is in one is where that is.
std::optional<MadeUpWorld> make_up_start(const plan::Plan& plan, std::uint32_t task,
                                         std::uint32_t start, Lies lies,
                                         std::span<const BegunIn> in = {});

// What a condition among the task's metrics says when the world has stayed as it is for 8 control
// steps, more than any rule counts.
Result<bool> judge_world(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric,
                         MadeUpWorld world);

// The same of worlds one after the other, each for so many steps; they begin as the first does.
Result<bool> judge_worlds(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric,
                          std::vector<MadeUpWorld> worlds);

}  // namespace probe::vm
