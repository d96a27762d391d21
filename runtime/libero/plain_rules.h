// The benchmark's rules of success once more, as its own code has them (LIBERO's envs/predicates and
// object_states), of its names and models: what the rules of an import are held against. Knows
// nothing of plans.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "runtime/libero/records.h"

namespace probe::libero {

// One state of a task, by the benchmark's names.
struct PlainState {
  std::map<std::string, Pose, std::less<>> objects, fixtures;
  std::map<std::string, double, std::less<>> joints;  // rad, m: "wooden_cabinet_1_top_level"
};

class PlainRules {
 public:
  struct Fact {
    std::string rule, what, where;  // `where` of `on` and `in` alone
  };

  // `classes`: libero_object_classes.json, the models as they are composed. Fails (kUsage) naming
  // what of either is lacking or is no rule, thing or site of theirs.
  static Result<PlainRules> create(const Json& classes, const RecordedTask& task);

  const std::vector<Fact>& goal() const { return goal_; }
  // All facts of the goal at once. `touching`: everything touches everything, or nothing anything.
  // The state has every thing and joint of the task.
  bool holds(const PlainState& state, bool touching) const;
  // About where a fact of the goal wants its object (m, world), and how far from there by far.
  std::pair<Vec3, Vec3> wanted(const PlainState& state, const Fact& fact) const;

 private:
  struct Joint {
    std::string name;
    bool slides = false;  // along y; else it turns about z
  };
  struct Site {
    std::string name;
    Pose pose;  // in its body's frame
    Vec3 size = Vec3::Zero();
  };
  struct Body {
    std::string name;
    int parent = -1;
    Pose pose;  // in its parent's frame, joints at 0
    std::vector<Joint> joints;
    std::vector<Site> sites;
  };
  using Model = std::vector<Body>;  // parents first
  // A box that things are in or on.
  struct Region {
    std::string thing;  // empty: of the table or the floor, `site` in world
    std::size_t body = 0;
    Site site;
  };

  static Result<Model> read_model(const Json& classes, const std::string& cls);
  Status read_region(const RecordedTask& task, const std::string& name);
  Status check(const Fact& fact, const std::string& where) const;
  Pose body_pose(const PlainState& state, const std::string& thing, std::size_t body) const;
  Site placed(const PlainState& state, const Region& region) const;
  bool holds(const PlainState& state, const Fact& fact, bool touching) const;

  std::map<std::string, Model, std::less<>> models_;  // by thing
  std::map<std::string, Region, std::less<>> regions_;
  std::vector<std::string> objects_;
  std::vector<Fact> goal_;
};

}  // namespace probe::libero
