// Where colliders are: poses, boxes and bounds on speed of links, bodies and what stands still.
#pragma once

#include <vector>

#include "runtime/world/articulation.h"
#include "runtime/world/state.h"

namespace probe::world {

Collider make_collider(std::shared_ptr<const scene::CollisionShape> shape, double friction,
                       double patch, double give = 0);

// Of the links that move, at the tree's last update and the world's speeds `u`.
void place_links(const Articulation& articulation, const JointArray& u,
                 std::vector<Collider>* colliders);
void place_body(const Body& body, Collider* collider);
// For good: a link of a base, or a fixture.
void place_still(const Pose& pose, Collider* collider);

}  // namespace probe::world
