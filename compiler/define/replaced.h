// Where a scene has a copy of a fixture in its place, what a task says of the one is said of the
// other: of its parts, its regions and its joints.
#pragma once

#include "compiler/model/model.h"

namespace probe::sema {

// Whether `robot` is `of`, or a copy of it (or of a copy): what is mounted on the one fits the
// other, where that has the link.
bool is_copy_of(const Model& model, RobotId robot, RobotId of);

// The fixture of the scene that stands for `id`: itself, else the only one that has a copied
// declaration in common with it and stands there; kNone where none does, or several.
FixtureId standing_for(const Model& model, const Scene& scene, FixtureId id);
// The same of a part or a region, by its own name; an object is itself.
ObjectId standing_for(const Model& model, const Scene& scene, ObjectId thing);

// The same where the copy stands at the very place of the first; one that stands elsewhere is another
// thing, and `thing` is itself.
ObjectId same_as(const Model& model, const Scene& scene, ObjectId thing);

// Roles, distractors, starts of joints and the solution of a task, as its scene has their fixtures.
// What no fixture of the scene stands for is left as it is, to be reported where it is looked for.
void follow_fixtures(const Model& model, Task& task);

}  // namespace probe::sema
