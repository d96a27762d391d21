#include "runtime/ask/measured_parts.h"

#include <algorithm>
#include <set>

#include "runtime/plan/isa.h"

namespace probe::ask {
namespace {

// What a program's instructions name.
struct Measured {
  std::set<std::uint32_t> joints;  // among those of the scene's fixtures
  std::set<std::uint32_t> bodies;  // task-local
};

Measured measured_in(const plan::Plan& plan, std::uint32_t program) {
  Measured named;
  for (const plan::Instruction& code : plan.code(plan.programs()[program])) {
    const plan::OpInfo& info = *plan::find_op(code.op);
    for (const auto& [kind, value] : {std::pair(info.a, code.a), std::pair(info.b, code.b)}) {
      if (kind == plan::Kind::kJoint) named.joints.insert(value);
      if (plan::is_body(kind)) named.bodies.insert(value);
    }
  }
  return named;
}

// The joint of the scene's fixtures that moves each of kParts that one moves.
std::vector<std::uint32_t> joints_of_parts(const plan::Plan& plan, const plan::SceneRecord& scene) {
  std::vector<std::uint32_t> joints(plan.parts().size(), plan::kNone);
  std::uint32_t first = 0;
  for (const std::uint32_t index : plan.fixtures(scene)) {
    const plan::FixtureRecord& fixture = plan.fixtures()[index];
    for (std::uint32_t i = 0; i < fixture.parts.count; ++i) {
      const plan::PartRecord& part = plan.parts()[fixture.parts.first + i];
      if (part.joint != plan::kNone) joints[fixture.parts.first + i] = first + part.joint;
    }
    first += fixture.joints.count;
  }
  return joints;
}

}  // namespace

std::vector<MeasuredPart> measured_parts(const plan::Plan& plan,
                                         const plan::QuestionRecord& question) {
  if (question.program == plan::kNone) return {};
  const plan::TaskRecord& task = plan.tasks()[question.task];
  const Measured named = measured_in(plan, question.program);
  const std::vector<std::uint32_t> joints = joints_of_parts(plan, plan.scenes()[task.scene]);
  const auto bodies = plan.bodies(task);
  std::vector<MeasuredPart> parts;
  std::set<std::uint32_t> told;  // joints
  for (std::uint32_t body = 0; body < bodies.size(); ++body) {
    if (bodies[body].kind != static_cast<std::uint32_t>(plan::BodyKind::kPart)) continue;
    const plan::PartRecord& part = plan.parts()[bodies[body].index];
    const std::uint32_t joint = joints[bodies[body].index];
    const bool by_joint = joint != plan::kNone && named.joints.contains(joint);
    if (!by_joint && !named.bodies.contains(body)) continue;
    const std::string_view said = plan.text(part.text);
    const std::string name(said.empty() ? plan.text(part.name) : said);
    if (by_joint && !told.insert(joint).second) {
      // Another link that the joint moves: either shows where it stands.
      for (MeasuredPart& known : parts) {
        if (joints[bodies[known.bodies.front()].index] == joint) known.bodies.push_back(body);
      }
      continue;
    }
    parts.push_back({name, {body}});
  }
  return parts;
}

}  // namespace probe::ask
