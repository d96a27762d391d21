// Whether an arm can take an object standing at a place and set it down there, by inverse
// kinematics of its own chain. Answers are kept by pose, so that a suite asks each question once.
// Knows nothing of collisions or of the way there.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "compiler/model/model.h"
#include "runtime/robot/ik.h"
#include "runtime/robot/kinematics.h"

namespace probe::sema {

// How far a place lies from the robot's base (m), and whether that is between its least and its
// most reach; a robot of which neither is said reaches everywhere.
double distance_to_base(const Scene& scene, const Start::Placed& placed);
bool is_in_annulus(const Robot& robot, double distance);

// How near the tool comes to a pose that it cannot take.
struct Shortfall {
  double position = 0;  // m
  double rotation = 0;  // rad
  double above = 0;     // m, how much of it is straight above the pose
};

class Arm {
 public:
  // Nothing when the arm cannot be asked: its description is not there, the scene gives no joints,
  // or it has too few driven joints for any place.
  static std::optional<Arm> of(const Model& model, const Scene& scene);

  // For the tool's centre at this place of the world (m), pointing down, at any of several turns
  // about the vertical; of an arm with too few joints to choose how its tool points, pointing
  // anywhere but upwards. Nothing when the arm gets there, or when too much has been asked already.
  std::optional<Shortfall> misses(double x, double y, double z);

 private:
  Arm(robot::Chain chain, std::vector<double> start, Pose base)
      : chain_(std::move(chain)), start_(std::move(start)), base_(base) {}
  std::optional<Shortfall> solve(const Vec3& at) const;
  std::optional<Shortfall> solve_place(const Vec3& at) const;
  Shortfall shortfall(const Vec3& at, std::span<const double> q,
                      const robot::IkResult& result) const;

  robot::Chain chain_;
  std::vector<double> start_;
  Pose base_;
  std::map<std::array<double, 3>, std::optional<Shortfall>> known_;
};

}  // namespace probe::sema
