// What an episode asks of a policy: an action for each observation. A policy sees pictures,
// proprioception and the prompt. Scripted policies (the expert and its kin) may also look at the
// privileged view; a wire client never does.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/action.h"

namespace probe::robot {
struct Robot;
}

namespace probe::policy {

using robot::Action;

struct Image {
  int width = 0, height = 0;
  std::span<const std::uint8_t> rgb;  // width * height * 3, row 0 on top
};

struct Proprioception {
  Pose tcp_in_base;               // the tool centre point link in the robot's base frame
  double openness = 1;            // 0 closed .. 1 open
  std::vector<double> joints;     // rad and m, in the plan's drive order
  std::size_t finger_joints = 0;  // how many of them, the last, move fingers

  std::size_t arm_joints() const { return joints.size() - std::min(finger_joints, joints.size()); }
};

// How a scripted policy fails (kNoSkill) in a task that asks for what it has no skill for: a status
// of its own, and no failed start.
inline constexpr std::string_view kNoSolution = "no solution in skills for this goal";
// How it begins to say that the robot's hand is none that it has skills for: the same status.
inline constexpr std::string_view kOtherHand =
    "the expert grasps with two fingers that close on each other";
// What it says where actions are late: it decides by what is now, and would fail where a start can
// be done.
inline constexpr std::string_view kLateActions = "the expert does not plan ahead of late actions";
// How it begins to say that a skill of the solution cannot be done where the episode begins: the
// arm does not reach it, or the hand finds no hold.
inline constexpr std::string_view kSkillCannot = "skill ";

// An object's collision hulls and where it is; all but the last two are fixed in an episode.
struct PrivilegedObject {
  std::string name;
  std::vector<std::vector<Vec3>> parts;  // convex parts' vertices, model frame
  std::optional<Vec3> center_of_mass;    // model frame
  Vec3 box_min = Vec3::Zero(), box_max = Vec3::Zero();
  Pose pose;                         // model frame in world, now
  std::vector<bool> finger_contact;  // a finger of the robot, over the last substep
};

// What stands in the scene and is no object: a fixture, or a link of one that has joints.
struct PrivilegedFixture {
  // What moves it: it goes by `axis` for every m, or turns about `axis` through `point`.
  struct Joint {
    bool slides = false, endless = false;
    Vec3 axis = Vec3::UnitX(), point = Vec3::Zero();  // the fixture's own frame; unit length
    double lower = 0, upper = 0;                      // m or rad
    double closed = 0, rest = 0;                      // where it is closed; where it began
    double position = 0;                              // now
    std::size_t number = 0;                           // among the joints of all fixtures
  };
  std::string name;
  std::vector<std::vector<Vec3>> parts;  // convex parts' vertices, its own frame
  Pose pose;  // of that frame in world, now; what never moves has the world's frame
  std::optional<Joint> joint = {};  // none for what stands
};

// What success asks for.
enum class Goal : std::uint8_t {
  kOnTarget,
  kAway,     // anywhere but on the target, still in the hand at the end
  kLifted,   // in the hand above where it was
  kOther,    // nothing that is found by moving the source about
  kNothing,  // it is so as the episode begins
};

// A step of a solution, by indices into the privileged view; -1 for none.
struct Skill {
  enum class Kind : std::uint8_t { kPick, kPut, kOpen, kClose, kTurn, kPress, kPush };
  enum class Place : std::uint8_t { kOn, kIn, kBeside };
  Kind kind = Kind::kPick;
  int object = -1;   // that is picked, put, pushed
  int fixture = -1;  // that is opened, closed, turned, pressed
  // Of a put.
  Place place = Place::kOn;
  int to_object = -1, to_fixture = -1;  // both none: the surface
  struct Box {
    Vec3 low, high;  // in the frame of what it is put to; of the surface in the world's
    Pose turned;     // the box's own frame in that one
  };
  std::optional<Box> region;
  bool shares = false;  // `region` is the expert's: beside others on or in `to_object`
  bool fully = false;   // the expert's, of an opening: to its end
  // Of a turn, rad: from where it is closed, or from where it is.
  double amount = 0;
  bool by = false;
  std::string name = {};  // "skill 2 `put carrot in cabinet.inside_top`"
};

// What is around, some of it against the task's baseline, where the plan has that: what policies
// with a known weak spot go by (weak.h).
struct Surroundings {
  double ambient = 0, power = 0;  // of the light; of all its lamps together
  double camera_moved = 0;        // m, of the first camera in its mount's frame
  int clutter = 0;                // objects more than there
  bool reworded = false;          // another instruction
};

// The privileged view.
struct Privileged {
  Surroundings surroundings;
  std::vector<PrivilegedObject> objects;  // in the order of the task's bodies
  int source = 0, target = 1;             // indices into `objects`; -1 for none
  int first_distractor = 2;               // the others follow it; -1 for none

  // Role 0 is the source, 1 the target, 2.. distractors: an index into `objects`, -1 for none.
  int object_of(int role) const {
    const int at = role == 0                          ? source
                   : role == 1                        ? target
                   : role < 0 || first_distractor < 0 ? -1
                                                      : first_distractor + role - 2;
    return at < static_cast<int>(objects.size()) ? at : -1;
  }
  std::vector<PrivilegedFixture> fixtures;
  std::size_t fixture_joints = 0;   // how many joints they have together
  std::vector<int> wrong_fixtures;  // parts among the task's distractors, as it lists them
  Pose base;                        // robot base in world
  double surface_z = 0;
  Goal goal = Goal::kOnTarget;
  std::vector<Skill> solution;  // how the task can be solved; what it says goes before the goal
};

// A scene's camera and what it shows now.
struct CameraImage {
  std::string_view camera;
  Image image;
};

struct Observation {
  Image image;                           // of the scene's first camera
  std::span<const CameraImage> cameras;  // all of the scene's cameras, the first included
  std::string_view prompt;
  Proprioception proprioception;
  const Privileged* privileged = nullptr;
  int step = 0;  // control steps done, 0 at the first observation
  int horizon = 0;
};

struct EpisodeStart {
  std::string_view task;
  std::string_view prompt;
  int index = 0;
  int seed = 0;
  std::uint64_t draw_seed =
      0;  // first 8 bytes of H(seed, episode): feed everything that draws from this
  int horizon = 0;
  int delay = 0;                        // control steps until an action acts
  double control_hz = 0;                // control steps a second
  const robot::Robot* robot = nullptr;  // lives as long as the episode
};

// How an episode ended, for policies that tell their server.
struct EpisodeEnd {
  bool completed = false;  // every control step was done; else something failed
  bool success = false;    // the metric of that name after the last step; false where there is none
  int steps = 0;           // control steps done
};

// What the first request of an episode carried to a policy server: hex SHA-256 of the prompt's
// bytes and of the pictures' pixel bytes, one picture after the other, after every change the
// profile asks for (case, resizing).
struct Delivery {
  std::string prompt_sha256;
  std::string image_sha256;
  bool operator==(const Delivery&) const = default;
};

class Answerer;
struct LiveStep;

class Policy {
 public:
  virtual ~Policy() = default;
  virtual Status begin(const EpisodeStart& start) = 0;
  virtual Result<Action> act(const Observation& observation) = 0;
  // Once after each begin(), however the episode went and also when begin() failed.
  virtual void end(const EpisodeEnd& /*end*/) {}
  // After end(): what showed only then that the episode was not answered as it seemed.
  virtual std::optional<Failure> spoiled() const { return std::nullopt; }
  // The same of the episode before the one that was begun last, where it showed even later.
  virtual bool is_earlier_spoiled() const { return false; }
  // After end(): what kept it from doing what it meant to, as people read it; of scripted policies
  // that know.
  virtual std::optional<std::string> remark() const { return std::nullopt; }
  // Of the episode that was begun last; nothing of a policy in this process, or before the first
  // request.
  virtual std::optional<Delivery> delivery() const { return std::nullopt; }
  // Its halves, where asking and doing are apart; see live.h.
  virtual Answerer* answerer() { return nullptr; }
  // Of the last act() in a world that does not wait, and nothing in one that does; see live.h.
  virtual const LiveStep* live_step() const { return nullptr; }
  // Sentences that whoever reads the results should know, such as what a server asked for in vain.
  virtual std::vector<std::string> notes() const { return {}; }
};

// Draws of a policy: a counter-based generator keyed by the episode, so that the order of episodes
// does not matter. SplitMix64 (Steele, Lea, Flood 2014) of key + counter.
class Draws {
 public:
  explicit Draws(std::uint64_t key) : key_(key) {}
  std::uint64_t next() {
    std::uint64_t z = key_ + 0x9e3779b97f4a7c15ull * ++counter_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }  // [0, 1)

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace probe::policy
