// Which residuals a move has, how many steps it gets and where the search starts.
#include "runtime/expert/path_planner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/expert/place_candidates.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

// What counts as much as 1 rad per step^3 of jerk.
constexpr double kPosition = 1.0 / 0.0005;  // m
constexpr double kRotation = 1.0 / 0.002;   // rad
constexpr double kTilt = 1.0 / 0.05;        // rad
constexpr double kInside = 1.0 / 0.003;     // m of clearance that lacks
constexpr double kOutside = 1.0 / 0.01;     // rad beyond limits of positions and moves
constexpr double kJerk = 1, kAcceleration = 1;

constexpr double kMargin = 0.012;       // m, wanted between what moves and obstacles
constexpr double kMarginGrows = 0.006;  // m a step, from what there is at the ends
// Of low ways, which nothing else keeps from what they cross: what hangs by its rim tilts.
constexpr double kLowMargin = 0.030, kLowMarginGrows = 0.012;
constexpr double kLimitMargin = 0.03;  // rad
constexpr double kMostMove = 0.35;     // rad a step and joint

constexpr double kMeanShift = 0.040, kMeanTurn = 0.24;  // of the tool a step, over a path
constexpr double kCorner =
    0.8;  // a smooth path's length to that of the straight lines it rounds off
constexpr double kLowCorner = 0.55;  // of low ways, whose corners are near to one another
constexpr int kFewestSteps = 5, kMostSteps = 24;
constexpr int kMoreSteps = 3;   // added where the clearance was not met
constexpr double kBad = 0.003;  // m less than nothing

struct Move {
  const Reach* reach = nullptr;
  const Recent* recent = nullptr;
  Pose goal;
  std::vector<JointVector> guides;  // joint positions to pass in a first guess, the goal's last
  std::vector<Ball> balls;
  Obstacles obstacles;
  std::vector<Ball> fingers;  // against `narrow` only, which leaves them little room at the goal
  Obstacles narrow;
  double narrow_margin = 0;
  bool straight_up = false;                              // leaves its start upwards
  double pace = 1;                                       // more: more steps
  double margin = kMargin, margin_grows = kMarginGrows;  // m; m a step
  double corner = kCorner;
};

// The margin that can be had `from` steps after the start, `left` before the goal. Prisms
// over-estimate hollow things, so either may begin inside one.
double margin_at(const Move& move, double from, double left, double at_start, double at_goal) {
  return std::min(
      {move.margin, at_start + move.margin_grows * from, at_goal + move.margin_grows * left});
}

void guess(const Move& move, Path& path) {
  const int n = path.steps();
  // Even in joint space through the guides, slow at both ends.
  std::vector<JointVector> knots{path.at(0)};
  knots.insert(knots.end(), move.guides.begin(), move.guides.end());
  std::vector<double> along{0};
  for (std::size_t i = 1; i < knots.size(); ++i) {
    along.push_back(along.back() + (knots[i] - knots[i - 1]).norm() + 1e-9);
  }
  for (int k = 1; k <= n; ++k) {
    const double s = static_cast<double>(k) / n;
    const double at = along.back() * s * s * s * (10 + s * (6 * s - 15));
    std::size_t i = 1;
    while (i + 1 < knots.size() && along[i] < at) ++i;
    const double f = (at - along[i - 1]) / (along[i] - along[i - 1]);
    path.set(k, knots[i - 1] + f * (knots[i] - knots[i - 1]));
  }
}

void add_line(const Move& move, const Pose& pose, int step, double share, Residuals& out) {
  const double w = share * kPosition;
  out.push_back(via(move.reach->chain(), {step, pose, {w, w, 0}, share * kRotation}));
}

Residuals residuals_of(const Move& move, const Path& path) {
  const robot::Chain& chain = move.reach->chain();
  const int n = path.steps();
  const Pose start = chain.pose(span_of(path.at(0)));
  const auto room = [&](const Pose& tool) {
    return least_clearance(tool, move.balls, move.obstacles, move.margin);
  };
  const double at_start = room(start), at_goal = room(move.goal);
  Residuals out;
  for (int k = 1; k <= n + 2; ++k) out.push_back(difference(k, 3, kJerk));
  for (int k = 1; k <= n + 1; ++k) out.push_back(difference(k, 2, kAcceleration));
  for (int k = 1; k <= n; ++k) {
    out.push_back(joint_limits(chain, k, kLimitMargin, kOutside));
    out.push_back(move_limit(k, kMostMove, kOutside));
    if (k < n) out.push_back(upright(chain, k, kTilt));
    for (const double half : {0.0, 0.5}) {
      std::vector<StepShare> at{{k, 1 - half}};
      if (half > 0) at.push_back({k - 1, half});
      const double from = k - half, left = n - from;
      out.push_back(clearance(chain, move.balls, move.obstacles,
                              {at, margin_at(move, from, left, at_start, at_goal), kInside}));
      if (!move.narrow.prisms.empty()) {
        out.push_back(
            clearance(chain, move.fingers, move.narrow, {at, move.narrow_margin, kInside}));
      }
    }
  }
  out.push_back(via(chain, {n, move.goal, Vec3::Constant(kPosition), kRotation}));
  add_line(move, move.goal, n - 1, 1, out);
  add_line(move, move.goal, n - 2, 0.2, out);
  if (move.straight_up) {
    add_line(move, start, 1, 1, out);
    add_line(move, start, 2, 0.1, out);
  }
  return out;
}

double clearance_along(const Move& move, const Path& path) {
  double least = 0.05;
  for (int k = 1; k <= path.steps(); ++k) {
    for (const double f : {0.25, 0.5, 0.75, 1.0}) {
      const JointVector q = (1 - f) * path.at(k - 1) + f * path.at(k);
      const Pose tool = move.reach->chain().pose(span_of(q));
      least = std::min(least, least_clearance(tool, move.balls, move.obstacles, least));
      least = std::min(least, least_clearance(tool, move.fingers, move.narrow, least));
    }
  }
  return least;
}

PlannedPath shaped(const Move& move, int steps) {
  PlannedPath out{Path(move.recent->back(), steps), 0, {}};
  for (int i = 0; i < Path::kPast; ++i) {
    out.path.set(i - Path::kPast + 1, (*move.recent)[static_cast<std::size_t>(i)]);
  }
  guess(move, out.path);
  out.fit = fit(out.path, residuals_of(move, out.path), {.iterations = 30, .least_gain = 3e-3});
  out.clearance = clearance_along(move, out.path);
  return out;
}

PlannedPath shaped(const Move& move) {
  Pose at = move.reach->chain().pose(span_of(move.recent->back()));
  double length = 0, turn = 0;
  for (const JointVector& guide : move.guides) {
    const Pose next = move.reach->chain().pose(span_of(guide));
    const robot::PoseError way = robot::pose_error(at, next);
    length += move.corner * way.position;
    turn += way.rotation;
    at = next;
  }
  const double even = move.pace * std::max(length / kMeanShift, turn / kMeanTurn);
  const int steps = std::clamp(static_cast<int>(std::ceil(even)) + 2, kFewestSteps, kMostSteps);
  PlannedPath best = shaped(move, steps);
  if (best.clearance >= -kBad) return best;
  PlannedPath slower = shaped(move, steps + kMoreSteps);
  return slower.clearance > best.clearance ? slower : best;
}

Ball ball(double x, double y, double z, double radius) { return {{x, y, z}, radius}; }

}  // namespace

constexpr int kFingerBalls = 8;  // the first of gripper_balls: two fingers, two edges, two heights

namespace {

// Fingers that turn are aslant: their inner and their outer faces, at the tips and half way up.
void add_turned(const robot::HandShape& g, double parted, std::vector<Ball>* out) {
  const robot::FingersAt at = robot::fingers_at(g.turning, g.openness_for(parted));
  for (const double side : {-1.0, 1.0}) {
    for (const bool is_inner : {true, false}) {
      for (const double share : {0.1, 0.5}) {
        const double x = at.tip_below - share * (at.tip_below + g.palm_above);
        const double inner = robot::inner_face(at, g.palm_above, x);
        const double outer = robot::outer_face(at, g.palm_above, x);
        const double r = std::min(0.5 * (outer - inner), g.finger_half);
        const double y = is_inner ? inner + r : outer - r;
        out->push_back(ball(std::min(x, at.tip_below - r), side * y, 0, r));
      }
    }
  }
}

}  // namespace

std::vector<Ball> gripper_balls(const robot::HandShape& g, double parted) {
  std::vector<Ball> out;
  if (!g.turning.empty()) add_turned(g, parted, &out);
  // Half a finger's thickness less 1 mm, m; not beyond half its width.
  const double thick =
      std::clamp(0.5 * (g.outside_half - g.opening_half) - 0.001, 0.0, g.finger_half);
  const double middle = parted + thick + 0.001;
  const double side = g.finger_half - thick;
  for (const double y : {-middle, middle}) {
    if (!g.turning.empty()) break;
    for (const double z : {-side, side}) {
      out.push_back(ball(g.tip_below - thick, y, z, thick));
      out.push_back(ball(-0.4 * g.palm_above, y, z, thick));
    }
  }
  constexpr double kPalm = 0.014;  // m: six balls of it leave no gap in the WidowX's palm
  const double palm = std::min({kPalm, g.palm_half, 0.5 * (g.palm_back + g.palm_front)});
  for (const double y : {-1.0, 0.0, 1.0}) {
    for (const double z : {-g.palm_back + palm, g.palm_front - palm}) {
      out.push_back(ball(-g.palm_above - palm, y * (g.palm_half - palm), z, palm));
    }
  }
  return out;
}

std::vector<Ball> held_balls(const Scene& scene, const Pose& tool) {
  std::vector<Ball> out;
  std::vector<Vec3> points;
  for (const std::vector<Vec3>& part : scene.source_parts) {
    points.insert(points.end(), part.begin(), part.end());
  }
  if (points.empty()) return out;
  std::vector<std::size_t> chosen;
  for (int i = 0; i < 27; ++i) {
    const Vec3 direction = scene.source_pose.rotation * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    std::size_t best = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (direction.dot(points[k] - points[best]) > 1e-9) best = k;
    }
    chosen.push_back(best);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  const Pose to_tool = tool.inverse();
  for (const std::size_t i : chosen) out.push_back({to_tool.apply(points[i]), 0});
  return out;
}

namespace {

// The source within a hollow target, whose walls then count one by one.
bool inside_target(const Scene& scene) {
  if (scene.target.whole.size() < 3 || scene.source.bottom > scene.target.top - 0.005) return false;
  const Prism around = make_prism(scene.target.whole, -1, 1);
  return distance_to(around, {scene.source.center.x(), scene.source.center.y(), 0}).value < 0;
}

}  // namespace

Obstacles obstacles_of(const Scene& scene, bool with_target) {
  Obstacles out;
  out.floor = scene.surface;
  const double below = scene.surface - 1;  // nothing passes beneath what stands
  const auto add = [&](const Footprint& f) {
    if (f.whole.size() >= 3) out.prisms.push_back(make_prism(f.whole, below, f.top));
  };
  for (const Footprint& other : scene.others) add(other);
  for (const Footprint& part : scene.fixtures) add(part);
  if (!with_target) return out;
  if (inside_target(scene)) {
    for (std::size_t i = 0; i < scene.target.parts.size(); ++i) {
      const Outline& part = scene.target.parts[i];
      if (part.size() >= 3) {
        out.prisms.push_back(make_prism(part, below, scene.target.part_tops[i]));
      }
    }
  } else {
    add(scene.target);
  }
  return out;
}

std::optional<PlannedPath> plan_approach(const Scene& scene, const Reach& reach, const Pick& pick,
                                         const Recent& recent) {
  const auto guides = reach.follow(span_of(recent.back()), std::array{pick.above, pick.grasp.tcp});
  if (!guides) return std::nullopt;
  const robot::HandShape& gripper = scene.hand;
  Move move;
  move.reach = &reach;
  move.recent = &recent;
  move.goal = pick.grasp.tcp;
  move.guides = *guides;
  move.balls = gripper_balls(gripper, gripper.gap_at(pick.grasp.open));
  move.obstacles = obstacles_of(scene, true);
  if (scene.source.whole.size() >= 3 && !pick.grasp.rim) {
    move.narrow.floor = scene.surface - 1;
    move.narrow.prisms = {make_prism(scene.source.whole, scene.surface - 1, scene.source.top)};
    move.fingers = std::vector<Ball>(move.balls.begin(), move.balls.begin() + kFingerBalls);
    move.narrow_margin = std::clamp(0.7 * side_room(gripper, pick.grasp.width), 0.0, 0.005);
  }
  if (scene.low_ways) {
    move.margin_grows = kLowMarginGrows;
    move.corner = kLowCorner;
    // From above into what is taken by a wall of it.
    if (pick.grasp.rim && scene.source.whole.size() >= 3)
      move.obstacles.prisms.push_back(
          make_prism(scene.source.whole, scene.surface - 1, scene.source.top));
  }
  return shaped(move);
}

std::optional<PlannedPath> plan_transport(const Scene& scene, const Reach& reach, const Pose& place,
                                          const Recent& recent, double pace) {
  const robot::HandShape& gripper = scene.hand;
  const Pose tool = reach.chain().pose(span_of(recent.back()));
  const double hang = std::max(gripper.tip_below, tool.position.z() - scene.source.bottom);
  const auto guides = way_to_place(scene, reach, span_of(recent.back()), hang, place);
  if (!guides) return std::nullopt;
  Move move;
  move.reach = &reach;
  move.recent = &recent;
  move.goal = place;
  move.guides = *guides;
  move.balls = gripper_balls(gripper, gripper.opening_half);
  const std::vector<Ball> held = held_balls(scene, tool);
  move.balls.insert(move.balls.end(), held.begin(), held.end());
  move.obstacles = obstacles_of(scene, true);
  move.straight_up = true;
  move.pace = pace;
  if (scene.low_ways) {
    move.margin = kLowMargin;
    move.margin_grows = kLowMarginGrows;
    move.corner = kLowCorner;
  }
  return shaped(move);
}

}  // namespace probe::expert
