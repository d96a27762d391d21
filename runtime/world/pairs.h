// Which pairs may touch, and where they do: margins, narrow phase with reuse, the contact list of a
// substep. Orders are fixed by the spec: links on the plane; for each body the plane, then links;
// then body pairs; then links and bodies on fixtures; then links on links.
#pragma once

#include <vector>

#include "runtime/world/hull_contact.h"
#include "runtime/world/records.h"
#include "runtime/world/rows.h"

namespace probe::world {

struct Plane {
  double height = 0;  // m
  double friction = 1;
};

// The first `links` colliders are links, the next `bodies` free bodies, the rest fixtures.
// `link_pairs`: links that may hit each other.
struct LinkPair {
  int a = 0, b = 0;
};
void make_pairs(const std::vector<Collider>& colliders, std::size_t links, std::size_t bodies,
                const std::vector<LinkPair>& link_pairs, const Plane& plane, PairTable* table);

// Whether any parts of two colliders overlap as they are placed now.
bool is_touching(const Collider& a, const Collider& b, Candidates* scratch);

// Gap (m) from which a contact exists: what both may cover in a substep and a half, at least the
// parameter.
double pair_margin(const Parameters& parameters, const Collider& a, const Collider* b);

// Fills problem->contacts and ->rows with n, p, gap, friction and the impulses of the last substep.
void find_contacts(const Parameters& parameters, const Plane& plane, std::uint64_t substep,
                   const std::vector<Articulation>& articulations,
                   const std::vector<Collider>& colliders, PairTable* table, Candidates* scratch,
                   Problem* problem);

// Writes solved impulses back to the records.
void store_impulses(const Problem& problem, PairTable* table);

// Starts the sums over the substeps of one control step; closes them for pairs that sleep.
void begin_sums(std::uint64_t substep, PairTable* table);
void add_frozen(const PairRecord& record, std::uint64_t substep, const PairTable& table,
                ColliderPair* pair);

// Forgets everything about one collider.
void drop_records(int collider, PairTable* table);

}  // namespace probe::world
