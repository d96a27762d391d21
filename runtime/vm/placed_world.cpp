#include "runtime/vm/placed_world.h"

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/plan/regions.h"
#include "runtime/plan/roles.h"

namespace probe::vm {
namespace {

constexpr double kInner = 5e-3;    // m: of a hollow thing
constexpr double kAside = 0.001;   // m: from one thing to the next in one place
constexpr double kBeside = 0.015;  // m: between the boxes of what lies beside one another

// Several things beside one stand on its sides in turn: on one side, a thing would be between that
// and a larger one, whatever the real world has.
Vec3 side_of(std::size_t index) {
  constexpr std::array<std::array<double, 2>, 4> kSides = {{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};
  const auto& [x, y] = kSides[index % kSides.size()];
  return {x, y, 0};
}

// `above` presses `below`, whichever has the lower number.
void touch(std::uint32_t above, std::uint32_t below, MadeUpWorld* world) {
  const auto a = static_cast<std::uint16_t>(above), b = static_cast<std::uint16_t>(below);
  if (a < b) return world->press_down(a, b);
  world->sample.contacts.push_back({b, a, {0, 0, kMadeUpContact}});
}

}  // namespace

void put_at(const plan::Plan& plan, const plan::TaskRecord& task, std::uint32_t object,
            const PutPlace& place, std::size_t index, MadeUpWorld* world) {
  const Vec3 aside(kAside * static_cast<double>(index), 0, 0);
  const Vec3& half = world->starts[object].half;
  std::uint32_t below = place.to;
  Vec3 at = Vec3::Zero();
  if (place.region != plan::kNone) {
    below = *plan::owner_of(plan.tables(), task, plan.regions()[place.region]);
    at = to_vec(plan::box_of(plan.tables(), place.region).middle);
    at += world->sample.bodies[below].origin;
  } else {
    const Vec3& half_below = world->starts[below].half;
    const Vec3& to = world->sample.bodies[below].position;
    if (place.relation == plan::SkillRelation::kBeside) {
      const double apart = half.head<2>().norm() + half_below.head<2>().norm() + kBeside;
      at = to + world->mirrored(apart * side_of(index) + Vec3(0, 0, half.z() - half_below.z()));
      below = world->surface;
    } else {
      // In a hollow thing it lies on the floor.
      const bool is_in = place.relation == plan::SkillRelation::kIn;
      at = to + Vec3(0, 0, half.z() + (is_in ? kInner - half_below.z() : half_below.z()));
      if (place.to < plan::roles_of(plan.tables(), task).objects)
        touch(place.to, world->surface, world);
    }
  }
  world->put(object, at + aside);
  touch(object, below, world);
}

void put_contacts_in_order(MadeUpWorld* world) {
  auto& contacts = world->sample.contacts;
  const auto pair = [](const ContactSample& c) { return std::pair(c.a, c.b); };
  std::ranges::stable_sort(contacts, {}, pair);
  const auto is_same = [&](const ContactSample& a, const ContactSample& b) {
    return pair(a) == pair(b);
  };
  contacts.erase(std::unique(contacts.begin(), contacts.end(), is_same), contacts.end());
}

}  // namespace probe::vm
