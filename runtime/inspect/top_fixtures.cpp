#include "runtime/inspect/top_fixtures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "runtime/inspect/checked_urdf.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/regions.h"
#include "runtime/robot/kinematics.h"
#include "runtime/scene/link_solids.h"

namespace probe::inspect {
namespace {

std::vector<Point> shadow(const scene::Solid& solid) {
  std::vector<Point> outline = box_outline(solid.axes);
  for (Point& corner : outline) {
    corner.x += solid.centre.x();
    corner.y += solid.centre.y();
  }
  return outline;
}

scene::Solid solid_of(const plan::TurnedBox& box) {
  const auto rows = plan::axes_of(box);
  scene::Solid solid{to_vec(box.middle), {}};
  for (std::size_t i = 0; i < 3; ++i)
    solid.axes[i] = box.half[i] * Vec3(rows[0][i], rows[1][i], rows[2][i]);
  return solid;
}

double open_end(const plan::FixtureJointRecord& joint) {
  return plan::closes_at_upper(joint.lower, joint.upper) ? joint.lower : joint.upper;
}

// Frames of a fixture's links, in world.
class PosedFixture {
 public:
  static Result<PosedFixture> create(const plan::Plan& plan, const plan::FixtureRecord& record,
                                     const AssetRoot& asset_root) {
    PROBE_ASSIGN(robot::RobotModel model, checked_urdf(plan, record.urdf, asset_root));
    std::vector<std::string> names;
    for (const plan::FixtureJointRecord& joint : plan.joints(record))
      names.emplace_back(plan.text(joint.joint));
    PROBE_ASSIGN(robot::Tree tree, robot::Tree::create(model, names));
    return PosedFixture(std::move(model), std::move(tree),
                        {to_vec(record.position), to_quat(record.rotation)});
  }

  std::vector<Pose> at(std::span<const double> joints) const {
    std::vector<Pose> poses(tree_.link_count());
    tree_.link_poses(joints, poses);
    for (Pose& pose : poses) pose = base_ * pose;
    return poses;
  }
  const robot::RobotModel& model() const { return model_; }

 private:
  PosedFixture(robot::RobotModel model, robot::Tree tree, const Pose& base)
      : model_(std::move(model)), tree_(std::move(tree)), base_(base) {}

  robot::RobotModel model_;
  robot::Tree tree_;
  Pose base_;
};

// How one fixture stands, joints at `starts`; `frames` gets those of its parts, by their number.
Status add_fixture(const plan::Plan& plan, const plan::FixtureRecord& record,
                   std::span<const double> starts, const AssetRoot& asset_root,
                   std::map<std::uint32_t, Pose>* frames, TopView* view) {
  PROBE_ASSIGN(const PosedFixture posed, PosedFixture::create(plan, record, asset_root));
  const std::string folder = std::filesystem::path(posed.model().path).parent_path().string();
  const std::vector<Pose> begun = posed.at(starts);
  const auto joints = plan.joints(record);
  const auto parts = plan.parts(record);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const plan::PartRecord& part = parts[i];
    const int found = posed.model().find_link(plan.text(part.link));
    if (found < 0) {
      return Failure{Fault::kUrdf,
                     "no link `" + std::string(plan.text(part.link)) + "` for part `" +
                         std::string(plan.text(part.name)) + "`",
                     posed.model().path};
    }
    const auto link = static_cast<std::size_t>(found);
    frames->emplace(record.parts.first + static_cast<std::uint32_t>(i), begun[link]);
    TopPart& seen = view->parts.emplace_back();
    seen.name = plan.text(part.name);
    const auto solids = scene::link_solids(posed.model().links[link], folder);
    for (const scene::Solid& solid : solids)
      seen.outlines.push_back(shadow(moved(solid, begun[link])));
    if (part.joint == plan::kNone || plan::is_endless(joints[part.joint])) continue;
    std::vector<double> open(starts.begin(), starts.end());
    open[part.joint] = open_end(joints[part.joint]);
    const Pose there = posed.at(open)[link];
    for (const scene::Solid& solid : solids) seen.open.push_back(shadow(moved(solid, there)));
  }
  return {};
}

}  // namespace

Status add_fixtures(const plan::Plan& plan, const plan::TaskRecord& task,
                    const AssetRoot& asset_root, TopView* view) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const std::vector<double> starts =
      task.episodes.count == 0
          ? std::vector<double>()
          : plan::joint_starts_of(plan.tables(), scene, plan.episodes(task)[0]);
  std::map<std::uint32_t, Pose> frames;
  std::span<const double> left = starts;
  for (const std::uint32_t number : plan.fixtures(scene)) {
    const plan::FixtureRecord& record = plan.fixtures()[number];
    if (left.size() < record.joints.count) break;  // a task without starts
    PROBE_TRY(
        add_fixture(plan, record, left.first(record.joints.count), asset_root, &frames, view));
    left = left.subspan(record.joints.count);
  }
  for (std::uint32_t number = 0; number < plan.regions().size(); ++number) {
    const plan::RegionRecord& region = plan.regions()[number];
    Pose frame;
    switch (static_cast<plan::BodyKind>(region.kind)) {
      case plan::BodyKind::kSurface:
        if (region.index != task.scene) continue;
        frame.position = {0, 0, scene.surface_z};
        break;
      case plan::BodyKind::kFixture:
        if (region.index != task.scene) continue;
        frame.position = Vec3(scene.fixture_position.data());
        break;
      case plan::BodyKind::kPart: {
        const auto found = frames.find(region.index);
        if (found == frames.end()) continue;
        frame = found->second;
        break;
      }
      default:
        continue;
    }
    view->regions.push_back({std::string(plan.text(region.name)),
                             shadow(moved(solid_of(plan::box_of(plan.tables(), number)), frame))});
  }
  return {};
}

}  // namespace probe::inspect
