#include "compiler/define/solution.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "compiler/define/role.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/skills.h"

namespace probe::sema {
namespace {

using Kind = SkillThing::Kind;

std::string text_of(const SkillOperand& operand) {
  return operand.name.text.empty() ? operand.owner.text
                                   : operand.owner.text + "." + operand.name.text;
}

const Region* region_named(const std::vector<Region>& regions, const std::string& name) {
  const auto at = std::ranges::find(regions, name, &Region::name);
  return at == regions.end() ? nullptr : &*at;
}

SkillThing region_of(const std::vector<Region>& regions, const std::string& owner,
                     const std::string& name, plan::BodyKind kind) {
  SkillThing thing;
  if (region_named(regions, name) == nullptr) return thing;
  thing.kind = Kind::kRegion;
  thing.region = owner + "." + name;
  thing.owner = kind;
  return thing;
}

SkillThing of_fixture(const Model& model, FixtureId id, const std::string& name) {
  const Fixture& fixture = model.fixtures[id];
  SkillThing thing;
  thing.fixture = id;
  for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
    const Fixture::Part& part = fixture.parts[i];
    // The fixture's own name is its root link, whether that has a name of its own or not.
    if (name.empty() ? part.joint.has_value() : !part.declared || part.name != name) continue;
    thing.kind = Kind::kPart;
    thing.part = i;
    return thing;
  }
  // A joint stands for the part that it moves, as in measures; of several the first.
  for (std::uint32_t i = 0; i < fixture.parts.size() && !name.empty(); ++i) {
    const Fixture::Part& part = fixture.parts[i];
    if (!part.joint || fixture.joints[*part.joint].name != name) continue;
    thing.kind = Kind::kPart;
    thing.part = i;
    return thing;
  }
  for (const Fixture::OwnRegion& own : fixture.regions) {
    if (own.region.name != name) continue;
    thing.kind = Kind::kRegion;
    thing.part = own.part;
    thing.region = fixture.name + "." + name;
    thing.owner = plan::BodyKind::kPart;
    return thing;
  }
  return thing;
}

class Checker {
 public:
  Checker(Context& context, const Task& task)
      : context_(context), task_(task), scene_(context.model.scenes[task.scene]) {}

  bool run() {
    return std::ranges::all_of(task_.solution, [this](const SkillUse& use) { return check(use); });
  }

 private:
  bool check(const SkillUse& use) {
    const plan::SkillInfo& info = plan::info_of(use.skill);
    const bool moves_object =
        info.takes == plan::SkillTakes::kObject || info.takes == plan::SkillTakes::kObjectPlace;
    const SkillThing what = find(use.what);
    if (what.kind == Kind::kNothing) return false;
    if (moves_object) {
      if (what.kind != Kind::kObjects)
        return refuse(use, "`" + std::string(info.word) + "` takes an object, `" +
                               text_of(use.what) + "` is none");
      return has_hand(use, info) &&
             (use.relation == plan::SkillRelation::kNothing || place(use, what));
    }
    if (what.kind != Kind::kPart)
      return refuse(use, "`" + std::string(info.word) + "` takes a part of a fixture, `" +
                             text_of(use.what) + "` is none");
    return joint(use, what);
  }

  SkillThing find(const SkillOperand& operand) {
    SkillThing thing = find_thing(context_.model, task_, operand);
    if (thing.kind != Kind::kNothing) return thing;
    const std::string& owner = operand.owner.text;
    const std::string in = " in the solution of `" + task_.name + "`";
    const Model& model = context_.model;
    if (find_role(model, owner)) {
      context_.report(
          Code::P1102, operand.span,
          operand.name.text.empty()
              ? "nothing fills role `" + owner + "`" + in
              : "what fills role `" + owner + "` has no region `" + operand.name.text + "`" + in);
      return thing;
    }
    if (context_.symbols.fixtures.peek(owner)) {
      const auto id = static_cast<FixtureId>(*context_.symbols.fixtures.peek(owner));
      const Fixture& fixture = model.fixtures[id];
      if (std::ranges::find(scene_.fixtures, id) == scene_.fixtures.end()) {
        context_
            .report(Code::P0201, operand.span,
                    "fixture `" + owner + "` is not in scene `" + scene_.name + "`" + in)
            .label(scene_.span, "the scene");
        return thing;
      }
      std::vector<std::string_view> known;
      for (const Fixture::Part& part : fixture.parts) {
        if (part.declared) known.push_back(part.name);
      }
      for (const Fixture::OwnRegion& own : fixture.regions) known.push_back(own.region.name);
      report_unknown(context_.diagnostics, "part or region of `" + owner + "`",
                     {operand.name.span, operand.name.text}, known)
          .label(fixture.span, "the fixture");
      return thing;
    }
    if (context_.symbols.objects.peek(owner)) {
      context_.report(Code::P0201, operand.span,
                      operand.name.text.empty()
                          ? "object `" + owner + "` is not in the scene" + in
                          : "`" + text_of(operand) + "` is no region of the scene" + in);
      return thing;
    }
    std::vector<std::string_view> known = role_names(context_);
    for (const ObjectId object : task_.objects()) known.push_back(model.objects[object].name);
    for (const FixtureId fixture : scene_.fixtures) known.push_back(model.fixtures[fixture].name);
    known.push_back("surface");
    report_unknown(context_.diagnostics, "role, object or fixture",
                   {operand.owner.span, operand.owner.text}, known);
    return thing;
  }

  bool refuse(const SkillUse& use, const std::string& message) {
    context_.report(Situation::kSkillCannot, use.what.span, message + " in `" + task_.name + "`");
    return false;
  }

  bool has_hand(const SkillUse& use, const plan::SkillInfo& info) {
    const Robot& robot = context_.model.robots[scene_.robot];
    if (use.skill == plan::Skill::kPush || !robot.fingers.empty()) return true;
    context_
        .report(Code::P1402, use.span,
                "robot `" + robot.name + "` has no fingers to `" + std::string(info.word) +
                    "` with in `" + task_.name + "`")
        .label(robot.span, "the robot");
    return false;
  }

  bool place(const SkillUse& use, const SkillThing& what) {
    const SkillThing to = find(use.to);
    if (to.kind == Kind::kNothing) return false;
    const bool is_region = to.kind == Kind::kRegion;
    if (to.kind == Kind::kObjects && to.objects.size() != 1)
      return refuse(use, "`" + text_of(use.to) + "` is several objects, and one is wanted");
    const bool is_itself =
        (to.kind == Kind::kObjects || (is_region && to.owner == plan::BodyKind::kObject)) &&
        std::ranges::find(what.objects, to.objects.front()) != what.objects.end();
    if (is_itself)
      return refuse(use, "nothing is put onto itself, and `" + text_of(use.what) + "` is `" +
                             text_of(use.to) + "`");
    if (is_region && use.relation == plan::SkillRelation::kBeside)
      return refuse(use,
                    "`beside` takes an object or a part, `" + text_of(use.to) + "` is a region");
    if (to.kind == Kind::kSurface && use.relation != plan::SkillRelation::kOn)
      return refuse(use, "what lies free is put `on surface`");
    return true;
  }

  bool joint(const SkillUse& use, const SkillThing& what) {
    const Fixture& fixture = context_.model.fixtures[what.fixture];
    const Fixture::Part& part = fixture.parts[what.part];
    const std::string name = "`" + text_of(use.what) + "`";
    if (!part.joint) return refuse(use, "no joint moves " + name);
    const Fixture::Joint& joint = fixture.joints[*part.joint];
    if (use.skill != plan::Skill::kTurn) {
      if (joint.is_endless && use.skill != plan::Skill::kPress)
        return refuse(use, name + " turns without end and is neither open nor closed");
      return true;
    }
    if (joint.slides) return refuse(use, name + " slides and cannot be turned");
    const double range = joint.is_endless ? 1e9 : joint.upper - joint.lower;
    const double most =
        use.relation == plan::SkillRelation::kTo ? use.amount : std::abs(use.amount);
    const bool is_within = most <= range + 1e-9 && (use.relation == plan::SkillRelation::kBy ||
                                                    joint.is_endless || most >= 0);
    if (is_within) return true;
    return refuse(
        use, name + " does not turn that far: its way is " +
                 std::to_string(static_cast<int>(std::lround(range * 180 / 3.14159265358979))) +
                 "deg");
  }

  Context& context_;
  const Task& task_;
  const Scene& scene_;
};

}  // namespace

std::optional<std::vector<SkillUse>> read_solution(
    Context& context, const syntax::SolutionStmt& stmt,
    const std::function<syntax::Name(const syntax::Name&)>& bound) {
  const auto operand_of = [&](const syntax::SkillOperand& said) {
    SkillOperand operand{spelled(bound(said.owner)), {}, said.span};
    if (said.name) operand.name = spelled(*said.name);
    return operand;
  };
  std::vector<SkillUse> uses;
  for (const syntax::SkillNode& node : stmt.skills) {
    const auto& said = std::get<syntax::SkillStmt>(node);
    SkillUse use;
    use.skill = said.skill;
    use.span = said.span;
    use.what = operand_of(said.what);
    use.relation = said.relation;
    if (said.to) use.to = operand_of(*said.to);
    if (said.amount) {
      const auto value = read_si(context, *said.amount, dim::kAngle,
                                 {"a part is turned", plan::Magnitude::kJointPosition});
      if (!value) return std::nullopt;
      use.amount = *value;
    }
    uses.push_back(std::move(use));
  }
  return uses;
}

bool check_solution(Context& context, const Task& task) { return Checker(context, task).run(); }

SkillThing find_thing(const Model& model, const Task& task, const SkillOperand& operand) {
  const Scene& scene = model.scenes[task.scene];
  const std::string &owner = operand.owner.text, &name = operand.name.text;
  SkillThing thing;
  std::vector<ObjectId> objects;
  if (const auto role = find_role(model, owner)) {
    objects = task.objects_in(*role);
  } else {
    for (const ObjectId id : task.objects()) {
      if (model.objects[id].name == owner) objects = {id};
    }
  }
  // A role may be filled with a part or a region of a fixture, called as in the text.
  if (objects.size() == 1 && !task.is_object(objects.front())) {
    const std::string& filled = model.objects[objects.front()].name;
    const std::size_t dot = filled.find('.');
    const std::string fixture = filled.substr(0, dot);
    for (const FixtureId id : scene.fixtures) {
      if (name.empty() && model.fixtures[id].name == fixture)
        return of_fixture(model, id, dot == std::string::npos ? "" : filled.substr(dot + 1));
    }
    return thing;
  }
  if (std::ranges::any_of(objects, [&](ObjectId id) { return !task.is_object(id); })) return thing;
  if (!objects.empty()) {
    if (!name.empty()) {
      if (objects.size() != 1) return thing;
      const Object& object = model.objects[objects.front()];
      thing = region_of(object.regions, object.name, name, plan::BodyKind::kObject);
    } else {
      thing.kind = Kind::kObjects;
    }
    thing.objects = std::move(objects);
    return thing;
  }
  for (const FixtureId id : scene.fixtures) {
    if (model.fixtures[id].name == owner) return of_fixture(model, id, name);
  }
  if (owner == "surface") {
    if (!name.empty())
      return region_of(scene.surface_regions, owner, name, plan::BodyKind::kSurface);
    thing.kind = Kind::kSurface;
  } else if (owner == "fixture" && scene.fixture) {
    if (!name.empty())
      return region_of(scene.fixture_regions, owner, name, plan::BodyKind::kFixture);
    thing.kind = Kind::kStanding;
  }
  return thing;
}

}  // namespace probe::sema
