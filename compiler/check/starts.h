// The starts of one task as the checks of places see them, and the words for a place.
#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/geometry/in_frame.h"
#include "compiler/geometry/reachable.h"
#include "compiler/geometry/travel.h"
#include "compiler/model/model.h"
#include "compiler/names/reporter.h"
#include "runtime/base/asset_root.h"

namespace probe::sema {

struct TaskStarts {
  const Model& model;
  Reporter& reporter;
  const Task& task;
  const Layout& layout;
  bool like_is_fine = false;  // the task that this one copies starts well

  const Object& object(const Start::Placed& placed) const { return model.objects[placed.object]; }
  // Where to report: the layout, unless it is fine for the task that this one copies; then what
  // came in here.
  Span place(std::initializer_list<ObjectId> objects) const;
};

// Arms by scene; none for a scene whose arm cannot be asked.
using Arms = std::map<SceneId, std::optional<Arm>>;

// A collision shape of the robot as a scene's episodes begin, by the box around it.
struct ArmLink {
  std::string name;
  scene::Solid solid;  // world
};

// What each fixture with joints fills, and each scene's arm at the start, worked out once.
class Travels {
 public:
  // The model must live as long.
  Travels(const Model& model, AssetRoot asset_root)
      : model_(model), asset_root_(std::move(asset_root)) {}
  const std::optional<Travel>& of(const Scene& scene, FixtureId id);
  const std::vector<ArmLink>& arm(SceneId id);
  // m: from the lowest to the highest of the surface and of all that stands in the scene, wherever
  // its joints are; none where the shape of something is not known.
  struct Heights {
    double low = 0, high = 0;
  };
  std::optional<Heights> heights(const Scene& scene);

 private:
  const Model& model_;
  AssetRoot asset_root_;
  std::map<std::pair<FixtureId, double>, std::optional<Travel>> known_;  // by lift
  std::map<SceneId, std::vector<ArmLink>> arms_;
};

// What the cameras of a task see that stand still, and how far things are out of it: many tasks put
// the same before the same cameras.
class Lookout {
 public:
  static constexpr double kBehind = 1e9;  // px
  // "lies 12 pixels outside the image of", "lies behind": what stands before a camera's name.
  static std::string where(double out);

  // As they stand in one start.
  void look(const Model& model, const Scene& scene, const std::vector<View>& views,
            std::size_t start);
  // How many they are.
  std::size_t fixed() const { return fixed_.size(); }
  bool jitters() const { return jitters_; }
  // How far something is out of the camera that it is the least out of.
  struct Out {
    double pixels = kBehind;  // kBehind where it is behind each
    const Camera* of = nullptr;
  };
  // One camera must stand still.
  Out outside(const Object& object, const Start::Placed& placed);
  // The same of something that boxes make up, when more than half of their corners are out.
  Out outside(std::span<const scene::Solid> boxes) const;

 private:
  template <typename... Thing>
  Out least(const Thing&... thing) const;

  bool jitters_ = false;
  std::vector<Camera> seen_;
  struct Fixed {
    Frustum frustum;
    const Camera* camera;  // of the model
  };
  std::vector<Fixed> fixed_;
  // What stands where, and how it is turned: a frustum asks nothing else.
  using Key = std::array<double, 7>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  std::unordered_map<Key, Out, Hash> known_;
};
using Lookouts = std::map<std::pair<SceneId, std::vector<CameraId>>, Lookout>;

// A fixture of a task's scene whose parts are known, its joints where the task begins: alike in all
// starts, or start by start.
struct BegunFixture {
  const Fixture& fixture;
  const Travel& travel;
  std::vector<std::vector<double>> joints;
};
std::vector<BegunFixture> begun_fixtures(const TaskStarts& starts, Travels& travels);

// The box of what is placed, where it stands.
scene::Solid solid_of(const TaskStarts& starts, const Start::Placed& placed);
// Whether it stands over the edge of the surface.
bool is_over_edge(const TaskStarts& starts, const Start::Placed& placed);

void check_overlap(const TaskStarts& starts);            // P0501
// P0505; false when something was reported.
bool check_surface(const TaskStarts& starts, Travels& travels);
bool check_reach(const TaskStarts& starts, Arms& arms);  // P0502; as above
void check_frame(const TaskStarts& starts, Lookouts& lookouts);  // P0505 as a warning
void check_travel(const TaskStarts& starts, Travels& travels);                        // P1302
void check_motion(const TaskStarts& starts, Travels& travels);                        // P1511
void check_fixture_places(const Model& model, Travels& travels, Reporter& reporter);  // P1302

// In how many of a task's starts something is so, from the first of them on.
struct CountedStarts {
  std::size_t bad = 0, all = 0, first = 0;
  void add(std::size_t start) {
    if (bad++ == 0) first = start;
  }
  std::string text() const;                                // "in 8 of 24 starts of"
  std::string first_words(const std::string& what) const;  // "first in start 3: .."
};
// What tells one cause from another, of whatever task: names and the place that is to blame.
std::string cause_of(const Span& place, std::initializer_list<std::string_view> names);

std::string centimetres(double metres);  // "7.5cm"
// "carrot at (7.5cm, -2cm)".
std::string at(const Object& object, const Start::Placed& placed);

}  // namespace probe::sema
