// Which pairs may touch and what they remember: boxes, margins, narrow phase with reuse, the
// contact list of a substep. Orders are fixed by the spec: links on the plane; for each body the
// plane, then links; then body pairs; then links and bodies on fixtures; then links on links.
#pragma once

#include <vector>

#include "runtime/world/arm_dynamics.h"
#include "runtime/world/hull_contact.h"
#include "runtime/world/rows.h"
#include "runtime/world/state.h"

namespace probe::world {

// A pair of colliders (b = -1: the plane) and its records, one per pair of parts.
struct ColliderPair {
  int a = -1, b = -1;
  std::uint32_t first = 0, count = 0;
  double friction = 0;
  Vec3 sum = Vec3::Zero();  // impulse on A since the step began, world
};

struct PairTable {
  std::vector<ColliderPair> pairs;
  std::vector<PairRecord> records;
  std::uint64_t step_begin = 0;  // the substep that the sums begin with
  Candidates scratch;
};

struct Plane {
  double height = 0;
  double friction = 1;
};

// The first `links` colliders are links, the next `bodies` free bodies, the rest fixtures.
// `link_pairs`: links that may hit each other.
struct LinkPair {
  int a = 0, b = 0;
};
void make_pairs(const std::vector<Collider>& colliders, std::size_t links, std::size_t bodies,
                const std::vector<LinkPair>& link_pairs, const Plane& plane, PairTable* table);

// Poses, boxes and speeds of colliders. Sleeping bodies are left as they are.
void place_links(const ArmDynamics& arm, const JointArray& u, std::size_t links,
                 std::vector<Collider>* colliders);
void place_body(const Body& body, Collider* collider);
// For good: a link of the base or a fixture.
void place_still(const Pose& pose, Collider* collider);

// Whether any parts of two colliders overlap as they are placed now.
bool is_touching(const Collider& a, const Collider& b, Candidates* scratch);

double pair_margin(const Parameters& parameters, const Collider& a, const Collider* b);

// Fills problem->contacts with n, p, gap, friction and the impulses of the last substep.
void find_contacts(const Parameters& parameters, const Plane& plane, std::uint64_t substep,
                   const std::vector<Collider>& colliders, PairTable* table, Problem* problem);

// Writes solved impulses back to the records.
void store_impulses(const Problem& problem, PairTable* table);

// Starts the sums over the substeps of one control step; closes them for pairs that sleep.
void begin_sums(std::uint64_t substep, PairTable* table);
void add_frozen(const PairRecord& record, std::uint64_t substep, ColliderPair* pair,
                const PairTable& table);

// Forgets everything about one collider.
void drop_records(int collider, PairTable* table);

}  // namespace probe::world
