#include "runtime/inspect/top_fixtures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
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

// How a fixture's joints begin, and in which starts.
struct BegunJoints {
  std::vector<double> joints;
  std::vector<std::uint32_t> starts;
};
constexpr double kAlike = 1e-3;  // m, rad: not seen from above

// Of `count` joints from the scene's joint `first` on; those of the first start first.
std::vector<BegunJoints> begun_joints(const plan::Plan& plan, const plan::TaskRecord& task,
                                      std::size_t first, std::size_t count) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  std::vector<BegunJoints> all;
  for (std::uint32_t start = 0; const plan::EpisodeRecord& episode : plan.episodes(task)) {
    const std::vector<double> joints = plan::joint_starts_of(plan.tables(), scene, episode);
    const std::span<const double> here = std::span(joints).subspan(first, count);
    const auto known = std::ranges::find_if(all, [&](const BegunJoints& begun) {
      return std::ranges::equal(begun.joints, here,
                                [](double a, double b) { return std::abs(a - b) < kAlike; });
    });
    if (known == all.end()) {
      all.push_back({{here.begin(), here.end()}, {start}});
    } else {
      known->starts.push_back(start);
    }
    ++start;
  }
  return all;
}

std::vector<std::vector<Point>> shadows(const std::vector<scene::Solid>& solids, const Pose& at) {
  std::vector<std::vector<Point>> all;
  for (const scene::Solid& solid : solids) all.push_back(shadow(moved(solid, at)));
  return all;
}

// Where a part stands elsewhere than in the first start. Starts in which it stands alike, as other
// joints of its fixture alone differ, are one.
void add_others(const PosedFixture& posed, std::size_t link,
                const std::vector<scene::Solid>& solids, std::span<const BegunJoints> begun,
                TopPart* seen) {
  for (const BegunJoints& one : begun) {
    std::vector<std::vector<Point>> outlines = shadows(solids, posed.at(one.joints)[link]);
    std::vector<std::uint32_t>* starts = &seen->starts;
    if (outlines != seen->outlines) {
      auto known = std::ranges::find(seen->others, outlines, &TopPart::Begun::outlines);
      if (known == seen->others.end())
        known = seen->others.insert(known, {std::move(outlines), {}});
      starts = &known->starts;
    }
    starts->insert(starts->end(), one.starts.begin(), one.starts.end());
  }
  std::ranges::sort(seen->starts);
  for (TopPart::Begun& other : seen->others) std::ranges::sort(other.starts);
  if (seen->others.empty()) seen->starts.clear();
}

struct BegunFrame {
  Pose at;
  std::vector<std::uint32_t> starts;
};
using BegunFrames = std::map<std::uint32_t, std::vector<BegunFrame>>;  // by a part's number

// A region wherever starts have it; starts in which it lies alike are one.
void add_region(std::string_view name, const scene::Solid& box, std::span<const BegunFrame> frames,
                std::vector<TopRegion>* regions) {
  std::vector<TopRegion> seen;
  for (const BegunFrame& frame : frames) {
    std::vector<Point> outline = shadow(moved(box, frame.at));
    auto known = std::ranges::find(seen, outline, &TopRegion::outline);
    if (known == seen.end())
      known = seen.insert(known, {std::string(name), std::move(outline), {}});
    known->starts.insert(known->starts.end(), frame.starts.begin(), frame.starts.end());
  }
  for (TopRegion& region : seen) std::ranges::sort(region.starts);
  if (seen.size() == 1) seen.front().starts.clear();
  std::ranges::move(seen, std::back_inserter(*regions));
}

// How one fixture stands, its joints as they begin; `frames` gets those of its parts.
Status add_fixture(const plan::Plan& plan, const plan::FixtureRecord& record,
                   std::span<const BegunJoints> all, const AssetRoot& asset_root,
                   BegunFrames* frames, TopView* view) {
  const std::vector<double>& starts = all.front().joints;
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
    auto& stands = (*frames)[record.parts.first + static_cast<std::uint32_t>(i)];
    for (const BegunJoints& one : all) stands.push_back({posed.at(one.joints)[link], one.starts});
    TopPart& seen = view->parts.emplace_back();
    seen.name = plan.text(part.name);
    const auto solids = scene::link_solids(posed.model().links[link], folder);
    seen.outlines = shadows(solids, begun[link]);
    add_others(posed, link, solids, all, &seen);
    if (part.joint == plan::kNone || plan::is_endless(joints[part.joint])) continue;
    std::vector<double> open(starts.begin(), starts.end());
    open[part.joint] = open_end(joints[part.joint]);
    const Pose there = posed.at(open)[link];
    seen.open = shadows(solids, there);
  }
  return {};
}

}  // namespace

Status add_fixtures(const plan::Plan& plan, const plan::TaskRecord& task,
                    const AssetRoot& asset_root, TopView* view) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  BegunFrames frames;
  std::size_t first = 0;
  for (const std::uint32_t number : plan.fixtures(scene)) {
    const plan::FixtureRecord& record = plan.fixtures()[number];
    const auto begun = begun_joints(plan, task, first, record.joints.count);
    if (begun.empty()) break;  // a task without starts
    PROBE_TRY(add_fixture(plan, record, begun, asset_root, &frames, view));
    first += record.joints.count;
  }
  for (std::uint32_t number = 0; number < plan.regions().size(); ++number) {
    const plan::RegionRecord& region = plan.regions()[number];
    std::vector<BegunFrame> stands(1);
    switch (static_cast<plan::BodyKind>(region.kind)) {
      case plan::BodyKind::kSurface:
        if (region.index != task.scene) continue;
        stands[0].at.position = {0, 0, scene.surface_z};
        break;
      case plan::BodyKind::kFixture:
        if (region.index != task.scene) continue;
        stands[0].at.position = Vec3(scene.fixture_position.data());
        break;
      case plan::BodyKind::kPart: {
        const auto found = frames.find(region.index);
        if (found == frames.end()) continue;
        stands = found->second;
        break;
      }
      default:
        continue;
    }
    add_region(plan.text(region.name), solid_of(plan::box_of(plan.tables(), number)), stands,
               &view->regions);
  }
  return {};
}

}  // namespace probe::inspect
