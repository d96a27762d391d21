// Starts in and on other things: what a layout puts on an object or into a region of a fixture
// stands there, from below upwards, a little above what carries it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/define/starts.h"
#include "compiler/geometry/travel.h"
#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"

namespace probe::sema {

// An object that a line of a layout puts in or on something.
struct Put {
  ObjectId object = ObjectId::kNone;
  const Place* place = nullptr;
};

// What a line's `where` means in a task: an object of its scene, or a region of a fixture.
// Nothing where neither is there.
std::optional<ObjectId> where_of(const Model& model, const Task& task, const Place& place);
// All objects of a task that its layout puts somewhere, in the order of the lines.
std::vector<Put> puts_of(const Model& model, const Task& task);

class Supports {
 public:
  // The model must live as long.
  Supports(const Model& model, AssetRoot asset_root)
      : model_(model), asset_root_(std::move(asset_root)) {}

  // Gives a place and a height to all that is put, and a height to the objects that carry
  // something; those begin where they stand, the others fall. Objects of one line stand side by
  // side along the longer side of what carries them.
  std::optional<LayoutProblem> stack(const Layout& layout, const Task& task,
                                     const std::vector<Put>& puts, Start& start);

 private:
  struct Area;
  std::optional<Area> on_object(const Task& task, Start::Placed& base) const;
  std::optional<Area> in_region(const Task& task, const OfFixture& of);
  double height_in(const Area& area, const Object& object, const Start::Placed& member) const;
  const std::optional<Travel>& travel(const Scene& scene, FixtureId id);

  const Model& model_;
  AssetRoot asset_root_;
  std::map<std::pair<FixtureId, double>, std::optional<Travel>> travels_;  // by lift
};

}  // namespace probe::sema
