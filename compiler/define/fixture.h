// Fixtures with joints: what other constructs ask of them.
#pragma once

#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// A region's box: P0304 unless the second corner lies above the first on every axis. Nothing when
// something was reported.
std::optional<Region> read_region(Context& context, const syntax::RegionStmt& stmt);
// The newer of one name takes the place of the older.
void put_region(std::vector<Region>& regions, Region region);

// `start cabinet.top 4cm`, over what was said before of the same joint. False when reported.
// `decl`: the declaration it stands in, which does not take away what it says itself.
bool read_start(Context& context, const syntax::StartStmt& stmt, const Span& decl,
                std::vector<JointStart>& starts);

// Where the joints of the scene's fixtures begin in this task (m, rad), in the scene's order: as
// the task says, else its layout, else the fixture.
std::vector<double> joint_starts_of(const Model& model, const Task& task);

// The same in one start, where a file of starts says it: over the layout, not over the task.
std::vector<double> joint_starts_of(const Model& model, const Task& task, const Start& start);
// Of all starts one after the other where a file says joints of fixtures, else of all at once.
std::vector<double> joint_starts_in_all(const Model& model, const Task& task);

// At the same place, or as high above another surface.
bool stands_alike(const std::array<double, 3>& a, double surface_a, const std::array<double, 3>& b,
                  double surface_b);
// Whether the fixtures of both scenes act, stand and are felt alike.
bool same_fixtures(const Model& model, const Scene& a, const Scene& b);

}  // namespace probe::sema
