// Solutions as records.
#include <algorithm>

#include "compiler/define/solution.h"
#include "compiler/emit/emitter.h"

namespace probe::emit {
namespace {

using Kind = sema::SkillThing::Kind;

std::uint32_t body_of(const std::vector<lower::Body>& bodies, plan::BodyKind kind,
                      std::uint32_t index, std::uint32_t part = 0) {
  const auto at = std::ranges::find_if(bodies, [&](const lower::Body& body) {
    return body.kind == kind && body.index == index && body.part == part;
  });
  return at == bodies.end() ? plan::kNone : static_cast<std::uint32_t>(at - bodies.begin());
}

std::uint32_t body_of(const std::vector<lower::Body>& bodies, ObjectId object) {
  return body_of(bodies, plan::BodyKind::kObject, static_cast<std::uint32_t>(object));
}

}  // namespace

std::uint32_t Emitter::region_named(const std::string& name, plan::BodyKind kind,
                                    std::uint32_t index) {
  const plan::StringRef text = writer_.text(name);
  for (std::uint32_t i = 0; i < records().regions.size(); ++i) {
    const plan::RegionRecord& region = records().regions[i];
    if (region.kind == static_cast<std::uint32_t>(kind) && region.index == index &&
        region.name.offset == text.offset && region.name.length == text.length)
      return i;
  }
  return plan::kNone;
}

// A skill with a role that several fill is done with one after another.
void Emitter::add_skills(const sema::Task& task, const std::vector<lower::Body>& bodies,
                         std::uint32_t index) {
  for (const sema::SkillUse& use : task.solution) {
    plan::SkillRecord record;
    record.task = index;
    record.skill = static_cast<std::uint32_t>(use.skill);
    record.relation = static_cast<std::uint32_t>(use.relation);
    record.amount = use.amount;
    if (plan::info_of(use.skill).takes == plan::SkillTakes::kObjectPlace) {
      const sema::SkillThing to = sema::find_thing(model_, task, use.to);
      switch (to.kind) {
        case Kind::kNothing:
          continue;
        case Kind::kObjects:
          record.to = body_of(bodies, to.objects.front());
          break;
        case Kind::kPart:
          record.to = body_of(bodies, plan::BodyKind::kPart, static_cast<std::uint32_t>(to.fixture),
                              to.part);
          break;
        case Kind::kSurface:
          record.to = body_of(bodies, plan::BodyKind::kSurface, 0);
          break;
        case Kind::kStanding:
          record.to = body_of(bodies, plan::BodyKind::kFixture, 0);
          break;
        case Kind::kRegion: {
          std::uint32_t owner = scenes_[task.scene];
          if (to.owner == plan::BodyKind::kObject) owner = objects_[to.objects.front()];
          if (to.owner == plan::BodyKind::kPart)
            owner = records()
                        .fixtures[fixture_index(model_.scenes[task.scene], to.fixture)]
                        .parts.first +
                    to.part;
          record.region = region_named(to.region, to.owner, owner);
          break;
        }
      }
    }
    const sema::SkillThing what = sema::find_thing(model_, task, use.what);
    if (what.kind == Kind::kPart) {
      record.body = body_of(bodies, plan::BodyKind::kPart, static_cast<std::uint32_t>(what.fixture),
                            what.part);
      records().skills.push_back(record);
    }
    for (const ObjectId object : what.objects) {
      record.body = body_of(bodies, object);
      records().skills.push_back(record);
    }
  }
}

}  // namespace probe::emit
