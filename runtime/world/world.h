// A world: articulations, one horizontal surface, fixtures and free rigid bodies, stepped at a
// fixed rate by the contact stepper of this folder. Same spec and same calls give the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/robot/dynamics.h"
#include "runtime/world/spec.h"

namespace probe::world {

struct Stepper;

struct BodyState {
  Pose pose;      // model origin, world
  Vec3 center;    // m, centre of mass, world
  Vec3 velocity;  // m/s, of the centre of mass
  Vec3 spin;      // rad/s, world
};

// Who touches: links are those of all articulations in order, bodies those of WorldSpec::bodies,
// fixtures those of WorldSpec::fixtures.
enum class PartyKind : std::uint8_t { kSurface, kLink, kBody, kFixture };
struct Party {
  PartyKind kind = PartyKind::kSurface;
  std::uint16_t index = 0;
  bool operator==(const Party&) const = default;
};
// Two links that never hit each other although self-collision is on, and why.
struct ExcludedLinks {
  enum class Reason : std::uint8_t { kRigid, kNeighbours, kTouchingAtStart };
  std::uint16_t a = 0, b = 0;  // as Party counts links
  Reason reason = Reason::kRigid;
};
// Sum over all contacts of a pair, N s, world; exerted by b on a.
struct ContactImpulse {
  Party a, b;
  Vec3 on_a = Vec3::Zero();
};

// Two that stand in one another, by how much (m).
struct Overlap {
  Party robot, other;
  double depth = 0;
};

class World {
 public:
  // Fails (kWorld) on mass or inertia that no body can have, unknown joints or links,
  // non-finite numbers.
  static Result<std::unique_ptr<World>> create(WorldSpec spec);
  ~World();

  const WorldSpec& spec() const { return spec_; }

  // q and u of all articulations' joints, in the order of the specs: rad, m; rad/s, m/s.
  std::span<const double> joints() const;
  std::span<const double> joint_speeds() const;
  // The largest share of its force limit that any drive exerted during the last step().
  double drive_load() const;
  // One target a joint of each driven articulation, in their order; and the speeds (rad/s, m/s)
  // that they are to have there, none for all at rest. Speeds want drives with stiffness.
  void set_targets(std::span<const double> targets, std::span<const double> speeds = {});
  BodyState body(std::size_t index) const;
  // Puts a body anywhere, at rest.
  void set_body(std::size_t index, const Pose& model_pose);
  // While locked, rotation about world x and y is blocked for all free bodies (the drop at reset).
  void lock_tilt(bool locked);
  void stop_bodies();  // zero velocities

  // From now on the body moves at `velocity` (m/s, world), without turning: it pushes what gives
  // way and passes through what does not; weight and friction do not act on it. That ends when a
  // link of a driven articulation touches it, or with `let_go`; it goes on at this velocity then.
  void lead(std::size_t index, const Vec3& velocity);
  void let_go(std::size_t index);
  bool is_led(std::size_t index) const;
  // Its centre of mass where it is led now, or was when that ended; none of what never was led.
  std::optional<Vec3> led_to(std::size_t index) const;

  // Of an articulation and one link of its description, now: what a law of torques reads. Fails
  // (kWorld) for a link that is not there and for more joints than `Dynamics` holds.
  struct ToolRef {
    std::size_t articulation = 0;
    int link = -1;           // of the description
    std::size_t joints = 0;  // the first ones of the articulation, which alone move the link
  };
  Result<ToolRef> find_tool(std::string_view link, std::size_t joints,
                            std::size_t articulation = 0) const;
  void read_dynamics(const ToolRef& tool, robot::Dynamics* out) const;
  // The same with the tool's joints at rest at `q`, the others where they are, at rest as well.
  void read_dynamics_at(const ToolRef& tool, std::span<const double> q, robot::Dynamics* out) const;
  // N, N m in each joint of an articulation `by_efforts`, in the next substep alone: to be called
  // by what step() calls.
  void set_efforts(std::size_t articulation, std::span<const double> efforts);

  // Advances n substeps. Fails (kWorld) when a number is not finite, or a body is faster than
  // 50 m/s, far below the floor or 100 m away; the message names the body. The world must not be
  // used after that.
  Status step(int substeps) { return step(substeps, nullptr); }
  // The same with a controller that is called before each substep, to read the world and to set
  // efforts.
  Status step(int substeps, const std::function<void()>& control);

  // Contacts of the last substep with a nonzero impulse, in a fixed order; sleeping bodies report
  // frozen impulses.
  std::span<const ContactImpulse> contacts() const { return contacts_; }
  // The same summed over all substeps of the last step(): what a sensor averages over a control
  // step. Empty after restore().
  std::span<const ContactImpulse> contact_sums() const { return sums_; }
  // Of what links of driven articulations stand in where they are now (not in one another), the
  // deepest; nothing where none is deeper than `least` (m).
  std::optional<Overlap> robot_stands_in(double least) const;
  // With self-collision, the pairs of links that were left out at load.
  std::span<const ExcludedLinks> excluded_links() const { return excluded_; }

  // The whole state including solver caches; restoring it continues bit for bit.
  std::vector<std::byte> save() const;
  // Fails (kWorld) on bytes of another world or of no world; nothing has changed then.
  Status restore(std::span<const std::byte> state);
  // Of q, u, targets and every body's pose and velocities: equal states, equal hashes.
  Sha256 state_hash() const;

  // For tests and benchmarks; what a task reads is measured in stage/measure.
  // World, at the present q: of a link as Party counts them, and of any URDF link, fixed ones too.
  Pose link_pose(std::size_t link) const;
  Pose frame_pose(std::string_view link_name, std::size_t articulation = 0) const;
  void set_joints(std::span<const double> q);  // all joints, at rest, targets equal
  std::size_t target_count() const { return targets_.size(); }
  const Stepper& stepper() const { return *stepper_; }

 private:
  explicit World(WorldSpec spec);
  Status check_state() const;
  void wake_all();
  void publish_contacts();
  void publish_sums();
  Party party(int collider) const;

  WorldSpec spec_;
  std::unique_ptr<Stepper> stepper_;
  std::vector<std::size_t> targets_;  // positions that have targets
  std::vector<int> urdf_links_;       // of links as Party counts them
  std::vector<ContactImpulse> contacts_, sums_;
  std::vector<ExcludedLinks> excluded_;
};

}  // namespace probe::world
