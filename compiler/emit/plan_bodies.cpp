#include "compiler/emit/plan_bodies.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/regions.h"
#include "runtime/plan/roles.h"

namespace probe::emit {
namespace {

// Behind every object that a text can have.
constexpr std::uint32_t kUnknownObject = 0x40000000;

std::string_view behind_dot(std::string_view name) { return name.substr(name.rfind('.') + 1); }

sema::Fixture::Joint joint_of(const plan::Plan& plan, const plan::FixtureJointRecord& record) {
  sema::Fixture::Joint joint;
  joint.name = plan.text(record.joint);
  joint.slides = plan::slides(record);
  joint.is_endless = plan::is_endless(record);
  joint.lower = record.lower;
  joint.upper = record.upper;
  return joint;
}

}  // namespace

PlanBodies::PlanBodies(const plan::Plan& plan, sema::Model& model) : plan_(plan), model_(model) {
  add_fixtures();
  for (std::uint32_t i = 0; i < plan.regions().size(); ++i) {
    const plan::RegionRecord& record = plan.regions()[i];
    sema::Region region;
    region.turned = plan::turned_box(plan.tables(), i);
    region.name = behind_dot(plan.text(record.name));
    region.low = record.low;
    region.high = record.high;
    regions_[{record.kind, record.index}].push_back(std::move(region));
  }
}

void PlanBodies::add_fixtures() {
  for (const plan::FixtureRecord& record : plan_.fixtures()) {
    const std::string_view name = plan_.text(record.name);
    const auto parts = plan_.parts(record);
    const auto joints = plan_.joints(record);
    const auto known = std::ranges::find(model_.fixtures, name, &sema::Fixture::name);
    const auto index = static_cast<std::uint32_t>(known - model_.fixtures.begin());
    const bool is_known = known != model_.fixtures.end() && known->parts.size() == parts.size() &&
                          known->joints.size() == joints.size();
    if (!is_known) {
      sema::Fixture fixture;
      fixture.name = name;
      for (const auto& joint : joints) fixture.joints.push_back(joint_of(plan_, joint));
      for (const plan::PartRecord& part : parts) {
        sema::Fixture::Part& made = fixture.parts.emplace_back();
        const std::string_view full = plan_.text(part.name);
        if (full != name) made.name = full.substr(std::min(full.size(), name.size() + 1));
        if (part.joint != plan::kNone) made.joint = part.joint;
        made.declared = part.declared != 0;
      }
      model_.fixtures.add(std::move(fixture));
    }
    const auto fixture = is_known ? index : static_cast<std::uint32_t>(model_.fixtures.size() - 1);
    for (std::uint32_t i = 0; i < parts.size(); ++i) parts_[record.parts.first + i] = {fixture, i};
  }
}

std::uint32_t PlanBodies::role_of(const plan::TaskRecord& task, std::uint32_t body) const {
  const plan::TaskRoles roles = plan::roles_of(plan_.tables(), task);
  if (body == roles.source) return static_cast<std::uint32_t>(sema::RoleId::kSource);
  if (body == roles.target) return static_cast<std::uint32_t>(sema::RoleId::kTarget);
  if (roles.is_distractor(body)) return lower::kDistractorRole;
  const std::string_view name = plan::role_of_body(plan_.tables(), roles, body);
  const auto known = std::ranges::find(model_.roles, name, &sema::Role::name);
  if (name.empty() || known == model_.roles.end())
    return static_cast<std::uint32_t>(sema::RoleId::kNone);
  return static_cast<std::uint32_t>(known - model_.roles.begin());
}

void PlanBodies::set_regions(lower::Body& body, plan::BodyKind kind, std::uint32_t index) {
  const auto known = regions_.find({static_cast<std::uint32_t>(kind), index});
  if (known == regions_.end()) return;
  body.regions = &known->second;
  body.owner = index + 1;
}

std::vector<lower::Body> PlanBodies::of(const plan::TaskRecord& task) {
  std::vector<lower::Body> out;
  const auto bodies = plan_.bodies(task);
  const std::size_t fingers = plan::finger_count(plan_.robots()[plan_.scenes()[task.scene].robot]);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const plan::BodyRecord& record = bodies[i];
    lower::Body& body = out.emplace_back();
    body.kind = static_cast<plan::BodyKind>(record.kind);
    body.name = plan_.text(record.name);
    switch (body.kind) {
      case plan::BodyKind::kObject: {
        const auto known = std::ranges::find(model_.objects, body.name, &sema::Object::name);
        body.index = known == model_.objects.end()
                         ? kUnknownObject + record.index
                         : static_cast<std::uint32_t>(known - model_.objects.begin());
        body.role = role_of(task, i);
        set_regions(body, body.kind, record.index);
        break;
      }
      case plan::BodyKind::kSurface:
      case plan::BodyKind::kFixture:
        set_regions(body, body.kind, task.scene);
        break;
      case plan::BodyKind::kLink:
        body.index = record.index;
        body.is_finger = record.index < fingers;
        break;
      case plan::BodyKind::kPart: {
        const auto [fixture, part] = parts_.at(record.index);
        body.index = fixture;
        body.part = part;
        break;
      }
    }
  }
  for (const plan::RoleRecord& role : plan::roles_of(plan_.tables(), task).things) {
    if (role.kind == static_cast<std::uint32_t>(plan::RoleKind::kRegion)) continue;
    const auto known = std::ranges::find(model_.roles, plan_.text(role.name), &sema::Role::name);
    if (plan::is_part_distractor(role)) {
      out[role.first].role = lower::kDistractorRole;
    } else if (known != model_.roles.end()) {
      out[role.first].role = static_cast<std::uint32_t>(known - model_.roles.begin());
    }
  }
  return out;
}

}  // namespace probe::emit
