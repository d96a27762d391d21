// Fixtures with joints and regions as records.
#include <algorithm>

#include "compiler/emit/emitter.h"

namespace probe::emit {

void Emitter::add_regions(const std::vector<sema::Region>& regions, const std::string& owner,
                          plan::BodyKind kind, std::uint32_t index) {
  for (const sema::Region& region : regions) {
    if (region.turned) {
      records().turned.push_back({size32(records().regions), 0, region.turned->middle,
                                  region.turned->half, region.turned->rotation});
    }
    records().regions.push_back({writer_.text(owner + "." + region.name),
                                 static_cast<std::uint32_t>(kind), index, region.low, region.high});
  }
}

std::uint32_t Emitter::fixture_index(const sema::Scene& scene, sema::FixtureId id) {
  const auto [known, is_new] =
      fixtures_.try_emplace({id, scene.fixtures_lift}, size32(records().fixtures));
  if (!is_new) return known->second;
  const sema::Fixture& fixture = model_.fixtures[id];
  const AssetOwner owner{AssetOwner::Kind::kFixture, static_cast<std::uint32_t>(id)};
  plan::FixtureRecord record;
  record.name = writer_.text(fixture.name);
  record.urdf = assets_.add(fixture.urdf.text, plan::AssetKind::kUrdf, fixture.urdf.span, owner);
  record.position = fixture.position;
  record.position[2] += scene.fixtures_lift;
  record.rotation = fixture.turn.rotation;
  record.friction = fixture.friction;
  std::vector<plan::FixtureJointRecord> joints;
  for (const sema::Fixture::Joint& joint : fixture.joints) {
    plan::FixtureJointRecord row;
    row.joint = writer_.text(joint.name);
    row.motion = static_cast<std::uint32_t>(joint.slides ? plan::JointMotion::kSlides
                                                         : plan::JointMotion::kTurns);
    row.lower = joint.lower;
    row.upper = joint.upper;
    row.friction = joint.friction;
    row.damping = joint.damping;
    row.stiffness = joint.stiffness;
    row.rest = joint.rest;
    row.start = joint.start;
    joints.push_back(row);
  }
  record.joints =
      plan::append(records().fixture_joints, std::span<const plan::FixtureJointRecord>(joints));
  if (std::ranges::any_of(fixture.joints, [](const auto& joint) { return joint.armature != 0; })) {
    std::vector<double> armatures;
    for (const sema::Fixture::Joint& joint : fixture.joints) armatures.push_back(joint.armature);
    record.armatures = plan::append(records().reals, std::span<const double>(armatures));
  }
  std::vector<plan::PartRecord> parts;
  for (const sema::Fixture::Part& part : fixture.parts) {
    plan::PartRecord row;
    row.name = writer_.text(fixture.body_name(part));
    row.link = writer_.text(part.link.text);
    row.text = writer_.text(part.text.text);
    row.joint = part.joint.value_or(plan::kNone);
    row.declared = part.declared ? 1 : 0;
    parts.push_back(row);
  }
  record.parts = plan::append(records().parts, std::span<const plan::PartRecord>(parts));
  for (const sema::Fixture::Shown& shown : fixture.shown) {
    const auto side = shown.from_below ? plan::ShownSide::kBelow : plan::ShownSide::kAbove;
    if (record.shown.count++ == 0) record.shown.first = size32(records().shown);
    records().shown.push_back(
        {writer_.text(shown.link.text), shown.index, static_cast<std::uint32_t>(side), shown.at});
  }
  for (const sema::Fixture::OwnRegion& own : fixture.regions) {
    add_regions({own.region}, fixture.name, plan::BodyKind::kPart, record.parts.first + own.part);
  }
  record.meshes = writer_.list(urdf_meshes(*fixture.model, fixture.urdf, owner));
  records().fixtures.push_back(record);
  return known->second;
}

}  // namespace probe::emit
