// `solution`: how a task can be solved, as its text says. What the words stand for depends on the
// task, since tasks inherit solutions.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// As written; nothing when a mistake was reported. `bound` is what a binder of `derive` stands for.
std::optional<std::vector<SkillUse>> read_solution(
    Context& context, const syntax::SolutionStmt& stmt,
    const std::function<syntax::Name(const syntax::Name&)>& bound);

// Each skill can be done with what the task has, by its robot; false when a mistake was reported.
bool check_solution(Context& context, const Task& task);

// What an operand stands for in a task.
struct SkillThing {
  enum class Kind : std::uint8_t { kNothing, kObjects, kPart, kSurface, kStanding, kRegion };
  Kind kind = Kind::kNothing;
  std::vector<ObjectId> objects;  // kObjects: all that fill the role; kRegion of an object: that
  FixtureId fixture = FixtureId::kNone;
  std::uint32_t part = 0;     // kPart, kRegion of a fixture: of the fixture's parts
  std::string region;         // kRegion: "cabinet.inside_top"
  plan::BodyKind owner = {};  // kRegion: whose
};
SkillThing find_thing(const Model& model, const Task& task, const SkillOperand& operand);

}  // namespace probe::sema
