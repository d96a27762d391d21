// Simulated seconds per CPU second at 500 Hz, one core: the arm and four objects. `moving`: the arm
// swings over resting objects. `grasping`: a held cube is lifted, held and carried.
#include <benchmark/benchmark.h>

#include <memory>
#include <optional>

#include "runtime/robot/control.h"
#include "tests/bench/need.h"
#include "tests/runtime/world/widowx.h"

namespace {

using probe::Pose;
using probe::Quat;
using probe::Vec3;
using probe::bench::need;

constexpr int kSubsteps = 100;  // a control step of 0.2 s
constexpr double kControlStep = 0.2;

// The table setting with a cube where the gripper will find it, carrot, plate and a box of a can's
// size.
class Table {
 public:
  Table() : widowx_(need(probe::world::load_widowx())) {
    probe::world::WorldSpec spec;
    spec.articulations = {widowx_->spec};
    spec.surface_z = kSurface;
    const std::string objects = VLAPROBE_SOURCE_DIR "/assets/objects/";
    const auto shape = [](probe::Result<probe::scene::CollisionShape> made) {
      return std::make_shared<const probe::scene::CollisionShape>(need(std::move(made)));
    };
    const auto add = [&](const char* name, std::shared_ptr<const probe::scene::CollisionShape> of,
                         double density, const Vec3& at) {
      spec.bodies.push_back({name, std::move(of), density, 0.5, Pose{at, Quat::Identity()}});
    };
    add("cube", shape(probe::scene::make_box_shape(Vec3(0.015, 0.015, 0.015))), 1000, kCube);
    add("carrot",
        shape(probe::scene::load_collision_obj(objects + "carrot/collision.obj", Vec3::Ones())),
        700, Vec3(-0.235, 0.1, kSurface + 0.0192));
    add("plate",
        shape(probe::scene::load_collision_obj(objects + "plate/collision.obj", Vec3::Ones())),
        1000, Vec3(-0.235, -0.1, kSurface + 0.0032));
    add("can", shape(probe::scene::make_box_shape(Vec3(0.0165, 0.0165, 0.03075))), 1000,
        Vec3(-0.085, 0.15, kSurface + 0.0309));
    world_ = need(probe::world::World::create(spec));
    probe::robot::EeControlSpec control;
    control.tcp_link = "ee_gripper_link";
    control.arm_joints = {"waist",        "shoulder",    "elbow",
                          "forearm_roll", "wrist_angle", "wrist_rotate"};
    control.finger_joints = {"left_finger", "right_finger"};
    controller_.emplace(need(probe::robot::EeDeltaPoseController::create(widowx_->model, control)));
    controller_->reset(world_->joints());
    run(500);
  }

  void run(int substeps) { need(world_->step(substeps)); }

  // One control step towards `goal` (tcp position, world) with the gripper pointing down.
  void act(const Vec3& goal, double gripper) {
    const Pose target = controller_->target_pose();
    const Pose base = widowx_->spec.base;
    const Vec3 wanted = base.inverse().apply(goal);
    Vec3 shift = wanted - target.position;
    if (shift.norm() > 0.03) shift *= 0.03 / shift.norm();
    // From the target's orientation to the top-down one, at most 0.3 rad.
    probe::Mat3 down;
    down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    const Eigen::AngleAxisd turn(
        probe::Mat3(down * target.rotation.toRotationMatrix().transpose()));
    const Vec3 rotation = turn.axis() * std::min(turn.angle(), 0.3);
    const std::array<double, 7> action = {shift.x(),    shift.y(),    shift.z(), rotation.x(),
                                          rotation.y(), rotation.z(), gripper};
    const auto targets = need(controller_->targets(action, world_->joints()));
    world_->set_targets(targets);
    run(kSubsteps);
  }

  void go(const Vec3& goal, double gripper, int steps) {
    for (int i = 0; i < steps; ++i) act(goal, gripper);
  }

  double cube_height() const { return world_->body(0).pose.position.z() - kSurface; }
  probe::world::World& world() { return *world_; }

  static constexpr double kSurface = 0.87;
  static inline const Vec3 kCube{-0.16, 0.0, kSurface + 0.0151};

 private:
  std::unique_ptr<probe::world::WidowX> widowx_;
  std::unique_ptr<probe::world::World> world_;
  std::optional<probe::robot::EeDeltaPoseController> controller_;
};

void moving(benchmark::State& state) {
  Table table;
  const Vec3 left(-0.1, 0.12, Table::kSurface + 0.2), right(-0.2, -0.12, Table::kSurface + 0.25);
  int step = 0;
  for (auto _ : state) table.act(++step / 12 % 2 ? left : right, 1);
  state.counters["rate"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * kControlStep, benchmark::Counter::kIsRate);
}
BENCHMARK(moving)->Name("physics/moving")->Unit(benchmark::kMillisecond)->MinTime(2);

void grasping(benchmark::State& state) {
  const Vec3 above = Table::kCube + Vec3(0, 0, 0.1), at = Table::kCube + Vec3(0, 0, 0.005);
  const Vec3 carried = above + Vec3(0, 0.12, 0.05);
  const auto lifted = [&] {
    auto table = std::make_unique<Table>();
    table->go(above, 1, 14);
    table->go(at, 1, 8);
    table->go(at, -1, 4);
    table->go(above, -1, 6);
    if (table->cube_height() < 0.06) state.SkipWithError("the cube was not lifted");
    return table;
  };
  // Swung for 24 minutes of its time the cube creeps out of the hand; two are enough.
  constexpr int kSwings = 600;
  auto table = lifted();
  int step = 0;
  for (auto _ : state) {
    if (++step % kSwings == 0) {
      state.PauseTiming();
      table = lifted();
      state.ResumeTiming();
    }
    table->act(step / 12 % 2 ? carried : above, -1);
  }
  if (table->cube_height() < 0.06) state.SkipWithError("the cube was dropped");
  state.counters["rate"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * kControlStep, benchmark::Counter::kIsRate);
}
BENCHMARK(grasping)->Name("physics/grasping")->Unit(benchmark::kMillisecond)->MinTime(2);

}  // namespace
