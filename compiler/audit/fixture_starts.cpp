#include "compiler/audit/fixture_starts.h"

#include <span>
#include <string>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/regions.h"

namespace probe::audit {
namespace {

// The middle of an object's box where a start places it; world.
Vec3 middle_of(const plan::Plan& plan, const plan::PlacementRecord& placement) {
  const plan::ObjectRecord& object = plan.objects()[placement.object];
  const Pose placed{to_vec(placement.position), to_quat(placement.rotation)};
  return placed.apply((to_vec(object.box_min) + to_vec(object.box_max)) / 2);
}

bool is_within(const plan::TurnedBox& box, const Vec3& at) {
  const Vec3 off = Pose{to_vec(box.middle), to_quat(box.rotation)}.inverse().apply(at);
  return (off.cwiseAbs().array() <= to_vec(box.half).array()).all();
}

}  // namespace

const std::optional<FixtureStarts::Model>& FixtureStarts::model_of(std::uint32_t fixture) {
  const auto [known, is_new] = models_.try_emplace(fixture);
  if (!is_new) return known->second;
  const plan::FixtureRecord& record = plan_.tables().fixtures[fixture];
  if (record.urdf == plan::kNone) return known->second;
  const std::string path(plan_.text(plan_.assets()[record.urdf].path));
  auto model = robot::load_urdf(compilation_.asset_root.file(path));
  if (!model) return known->second;  // a text that has such a file does not compile
  std::vector<std::string> joints;
  for (const auto& joint : plan::slice_of(plan_.tables().fixture_joints, record.joints))
    joints.emplace_back(plan_.text(joint.joint));
  auto tree = robot::Tree::create(*model, joints);
  if (tree) known->second.emplace(Model{*std::move(model), *std::move(tree)});
  return known->second;
}

std::vector<std::optional<Pose>> FixtureStarts::owner_poses(std::uint32_t task,
                                                            std::uint32_t start) {
  std::vector<std::optional<Pose>> poses(plan_.regions().size());
  const plan::TaskRecord& record = plan_.tasks()[task];
  const plan::SceneRecord& scene = plan_.scenes()[record.scene];
  const std::vector<double> joints =
      plan::joint_starts_of(plan_.tables(), scene, plan_.episodes(record)[start]);
  std::size_t first = 0;
  for (const std::uint32_t fixture : plan::slice_of(plan_.tables().list, scene.fixtures)) {
    const plan::FixtureRecord& stands = plan_.tables().fixtures[fixture];
    const auto own = std::span<const double>(joints).subspan(first, stands.joints.count);
    first += stands.joints.count;
    const auto& model = model_of(fixture);
    if (!model) continue;
    std::vector<Pose> links(model->tree.link_count());
    model->tree.link_poses(own, links);
    const Pose base{to_vec(stands.position), to_quat(stands.rotation)};
    for (std::uint32_t r = 0; r < poses.size(); ++r) {
      const plan::RegionRecord& region = plan_.regions()[r];
      const std::uint32_t from = stands.parts.first, to = from + stands.parts.count;
      if (static_cast<plan::BodyKind>(region.kind) != plan::BodyKind::kPart ||
          region.index < from || region.index >= to)
        continue;
      const int link = model->model.find_link(plan_.text(plan_.tables().parts[region.index].link));
      poses[r] = base * links[static_cast<std::size_t>(link)];
    }
  }
  return poses;
}

std::vector<vm::BegunIn> FixtureStarts::of(std::uint32_t task, std::uint32_t start) {
  std::vector<vm::BegunIn> found;
  const plan::TaskRecord& record = plan_.tasks()[task];
  if (plan_.scenes()[record.scene].fixtures.count == 0) return found;
  const std::vector<std::optional<Pose>> poses = owner_poses(task, start);
  const auto placements = plan_.placements(plan_.episodes(record)[start]);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Vec3 middle = middle_of(plan_, placements[i]);
    for (std::uint32_t r = 0; r < poses.size(); ++r) {
      if (!poses[r]) continue;
      const Vec3 at = poses[r]->inverse().apply(middle);
      const auto owner = plan::owner_of(plan_.tables(), record, plan_.regions()[r]);
      if (!owner || !is_within(plan::box_of(plan_.tables(), r), at)) continue;
      found.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(*owner), at});
      break;
    }
  }
  return found;
}

}  // namespace probe::audit
