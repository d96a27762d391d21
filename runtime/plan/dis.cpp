#include "runtime/plan/dis.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/isa.h"
#include "runtime/plan/moves.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/plan/source_line.h"

namespace probe::plan {
namespace {

// What programs are listed with: names of bodies come from one task that runs it.
class Lister {
 public:
  Lister(const Plan& plan, const TaskRecord& task, std::uint32_t program)
      : plan_(plan),
        program_(plan.programs()[program]),
        bodies_(plan.bodies(task)),
        joints_(joint_names_of(plan.tables(), plan.scenes()[task.scene])),
        constants_(plan.constants(program_)),
        metrics_(plan.metrics(program_)) {}

  void list(std::string& out) {
    const auto code = plan_.code(program_);
    for (std::uint32_t i = 0; i < code.size(); ++i) {
      source(out, program_.code.first + i);
      instruction(out, i, code[i]);
    }
  }

 private:
  // The source line once, above the first of the instructions that came from it.
  void source(std::string& out, std::uint32_t instruction) {
    const SpanRecord* span = plan_.span_of(SpanKind::kCode, instruction);
    if (span == nullptr) return;
    const TextRecord& text = plan_.texts()[span->text];
    const SourceLine line = line_at(plan_.tables().source(text), span->begin);
    if (span->text == last_text_ && line.number == last_line_) return;
    last_text_ = span->text;
    last_line_ = line.number;
    fmt::format_to(std::back_inserter(out), "; {}:{}  {}\n", plan_.tables().path(text), line.number,
                   line.text);
  }

  void instruction(std::string& out, std::uint32_t number, const Instruction& in) const {
    const OpInfo& op = *find_op(in.op);
    const std::string result = op.result == Kind::kUnused ? "" : fmt::format("r{}", in.dst);
    const std::string b = operand(op.b, in.b);
    std::string line = fmt::format("{:4}  {:<7} {:<5} {}{}{}", number, op.name, result,
                                   operand(op.a, in.a), op.b == Kind::kMetric ? " -> " : " ", b);
    line.resize(line.find_last_not_of(' ') + 1);
    line.push_back('\n');
    out += line;
  }

  std::string operand(Kind kind, std::uint16_t value) const {
    switch (kind) {
      case Kind::kUnused:
        return {};
      case Kind::kBool:
      case Kind::kReal:
      case Kind::kVector:
        return fmt::format("r{}", value);
      case Kind::kConstant:
        return fmt::format("{}", constants_[value]);
      case Kind::kThreeConstants:
        return fmt::format("({}, {}, {})", constants_[value], constants_[value + 1u],
                           constants_[value + 2u]);
      case Kind::kImmediate:
        return fmt::format("{}", value);
      case Kind::kBody:
      case Kind::kFinger:
        return std::string(plan_.text(bodies_[value].name));
      case Kind::kJoint:
        return joints_[value];
      case Kind::kState:
        return fmt::format("s{}", value);
      case Kind::kTimedState:
        return fmt::format("s{} for {} steps", value, plan_.states(program_)[value].n);
      case Kind::kMetric:
        return std::string(plan_.text(metrics_[value].name));
    }
    return "?";
  }

  const Plan& plan_;
  const ProgramRecord& program_;
  std::span<const BodyRecord> bodies_;
  std::vector<std::string> joints_;
  std::span<const double> constants_;
  std::span<const MetricRecord> metrics_;
  std::uint32_t last_text_ = kNone;
  std::size_t last_line_ = 0;
};

// Of a task that has others than source, target and distractors: the bodies that instructions name.
void list_roles(std::string& out, const Plan& plan, const TaskRecord& task) {
  const TaskRoles roles = roles_of(plan.tables(), task);
  if (roles.has_both() && roles.others.empty() && roles.things.empty()) return;
  for (std::uint32_t i = 0; i < roles.objects; ++i) {
    fmt::format_to(std::back_inserter(out), "  body {} {}: {}\n", i,
                   label_of_body(plan.tables(), roles, i), plan.text(plan.bodies(task)[i].name));
  }
  for (const RoleRecord& role : roles.things) {
    const bool is_part = role.kind != static_cast<std::uint32_t>(RoleKind::kRegion);
    fmt::format_to(std::back_inserter(out), "  {} {}: {} {}\n", is_part ? "body" : "region",
                   role.first, is_part_distractor(role) ? "distractor" : plan.text(role.name),
                   thing_in(plan.tables(), task, role));
  }
  out += "\n";
}

// `task` names the bodies.
void list_program(std::string& out, const Plan& plan, const TaskRecord& task, std::uint32_t index,
                  std::string_view users) {
  const ProgramRecord& program = plan.programs()[index];
  fmt::format_to(std::back_inserter(out), "program {} of {}\n", index, users);
  fmt::format_to(std::back_inserter(out), "  hash {}\n", to_hex(Sha256{program.hash}));
  fmt::format_to(std::back_inserter(out),
                 "  {} instructions, {} constants, {} states, {} metrics\n\n", program.code.count,
                 program.constants.count, program.states.count, program.metrics.count);
  list_roles(out, plan, task);
  Lister(plan, task, index).list(out);
}

// Programs of claims, the same way.
void list_claim_programs(std::string& out, const Plan& plan, std::uint32_t task) {
  std::vector<bool> listed(plan.programs().size(), false);
  for (const ClaimRecord& claim : plan.claims()) {
    if (listed[claim.program] || (task != kNone && claim.task != task)) continue;
    listed[claim.program] = true;
    const TaskRecord& of = plan.tasks()[claim.task];
    out += "\n";
    list_program(out, plan, of, claim.program,
                 fmt::format("claim \"{}\" is body {} of {}", plan.text(claim.text), claim.body,
                             plan.text(of.name)));
  }
}

// What brings later sentences, the same way.
void list_later_programs(std::string& out, const Plan& plan, std::uint32_t task) {
  for (const LaterRecord& later : plan.later()) {
    if (task != kNone && later.task != task) continue;
    const TaskRecord& of = plan.tasks()[later.task];
    out += "\n";
    list_program(out, plan, of, later.program,
                 fmt::format("{} then says \"{}\"", plan.text(of.name), plan.text(later.text)));
  }
}

// How tasks can be solved: of one, or of all.
void list_skills(std::string& out, const Plan& plan, std::uint32_t task) {
  std::uint32_t of = kNone;
  for (const SkillRecord& skill : plan.skills()) {
    if (task != kNone && skill.task != task) continue;
    if (skill.task != of) {
      of = skill.task;
      out += fmt::format("\nsolution of {}\n", plan.text(plan.tasks()[of].name));
    }
    out += "  " + skill_text(plan.tables(), skill) + "\n";
  }
}

// Programs of which a question has its right answer, below those of tasks: of one task, or of all.
void list_question_programs(std::string& out, const Plan& plan, std::uint32_t task) {
  std::vector<bool> listed(plan.programs().size(), false);
  for (const QuestionRecord& question : plan.questions()) {
    if (question.program == kNone || listed[question.program]) continue;
    if (task != kNone && question.task != task) continue;
    listed[question.program] = true;
    const FamilyRecord& family = plan.families()[question.family];
    const TaskRecord& of = plan.tasks()[question.task];
    out += "\n";
    list_program(out, plan, of, question.program,
                 fmt::format("question {}.{} of {}", plan.text(family.set), plan.text(family.name),
                             plan.text(of.name)));
  }
}

std::string numbers_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) text += fmt::format(" {}", number);
  return text;
}

// Robots of which more than their record is in the plan: numbers of the law, gears, fingers.
void list_robots(std::string& out, const Plan& plan) {
  const auto to = std::back_inserter(out);
  for (std::uint32_t i = 0; i < plan.robots().size(); ++i) {
    const RobotRecord& robot = plan.robots()[i];
    const LawRecord* law = plan.law(robot);
    const auto gears = plan.gears(robot);
    if (law == nullptr && gears.empty() && robot.more_fingers.count == 0) continue;
    fmt::format_to(to, "\nrobot {} {}: control {} at {} Hz\n", i, plan.text(robot.name),
                   robot.control, robot.control_hz);
    const auto control = static_cast<Control>(robot.control);
    if (law != nullptr && control == Control::kJointDelta) {
      fmt::format_to(to, "  steps from the {}, most {}\n",
                     (law->flags & kLawFromTarget) != 0 ? "last target" : "measured position",
                     law->most);
    } else if (law != nullptr && control == Control::kEeDeltaInterpolated) {
      fmt::format_to(to, "  paths of the arm{}, of the fingers{}\n", numbers_text(law->arm_path),
                     numbers_text(law->finger_path));
    } else if (law != nullptr && control != Control::kJointPosition) {
      fmt::format_to(to, "  kp{}, damping{}, output{}\n", numbers_text(law->kp),
                     numbers_text(law->damping), numbers_text(law->output));
      fmt::format_to(to, "  null {}, ramp {}, flags {}, most {}, home{}\n", law->null_kp, law->ramp,
                     law->flags, law->most, numbers_text(plan.home(*law)));
      fmt::format_to(to, "  grip pace {}, stiffness {}, limit {}\n", law->grip_pace,
                     law->grip_stiffness, law->grip_limit);
    }
    for (std::size_t g = 0; g < gears.size(); ++g) {
      fmt::format_to(to, "  {}: friction {}, armature {}\n", plan.text(plan.drives(robot)[g].joint),
                     gears[g].friction, gears[g].armature);
    }
    for (const FingerRecord& finger : slice_of(plan.tables().fingers, robot.more_fingers)) {
      fmt::format_to(to, "  finger {} opens{}\n", plan.text(finger.link),
                     numbers_text(finger.opens));
    }
  }
}

// What varies without a new mesh, as it stands in the records.
void list_variations(std::string& out, const Plan& plan) {
  const auto to = std::back_inserter(out);
  std::string text;
  const auto in = std::back_inserter(text);
  for (const ObjectRecord& o : plan.objects()) {
    if (o.scale != 0) fmt::format_to(in, "  {} scale {}\n", plan.text(o.name), o.scale);
    if (o.paint[3] != 0)
      fmt::format_to(in, "  {} paint {} {} {}\n", plan.text(o.name), o.paint[0], o.paint[1],
                     o.paint[2]);
    if (const CoverRecord* cover = plan.cover(o))
      fmt::format_to(in, "  {} texture {} side {}\n", plan.text(o.name),
                     plan.text(plan.assets()[cover->texture].path), cover->side);
  }
  for (const CameraRecord& c : plan.cameras()) {
    if (const SensorRecord* s = plan.sensor(c))
      fmt::format_to(in, "  {} noise {}, blur {}, exposure {}, patch{}, dropped {}, mirrored {}\n",
                     plan.text(c.name), s->noise, s->blur, s->exposure, numbers_text(s->patch),
                     s->dropped, s->mirrored);
  }
  for (const LightRecord& l : plan.lights()) {
    if (l.color != std::array<double, 3>{})
      fmt::format_to(in, "  {} color{}\n", plan.text(l.name), numbers_text(l.color));
    if (l.shading != 0)
      fmt::format_to(in, "  {} shading vertex, {} lamps\n", plan.text(l.name), l.lamps.count);
    for (const LampRecord& lamp : plan.lamps(l)) {
      constexpr std::array<const char*, 4> kKinds{"", "spot", "sun", "headlight"};
      fmt::format_to(in,
                     "    {} at{} along{} power {} specular {} ambient {} cutoff {} exponent {} "
                     "fade{}\n",
                     kKinds[lamp.kind], numbers_text(lamp.position), numbers_text(lamp.direction),
                     lamp.power, lamp.specular, lamp.ambient, lamp.cutoff, lamp.exponent,
                     numbers_text(lamp.fade));
    }
  }
  for (const SceneRecord& s : plan.scenes()) {
    for (const CoverRecord& cover : plan.covers(s))
      fmt::format_to(in, "  {} texture on {}: {} side {}\n", plan.text(s.name), cover.what,
                     plan.text(plan.assets()[cover.texture].path), cover.side);
  }
  for (const FixtureRecord& f : plan.fixtures()) {
    for (const ShownRecord& shown : plan.shown(f))
      fmt::format_to(
          in, "  {} shows {} while {} {} {}\n", plan.text(f.name), plan.text(shown.link),
          plan.text(plan.joints(f)[shown.joint].joint),
          shown.side == static_cast<std::uint32_t>(ShownSide::kAbove) ? ">=" : "<=", shown.at);
  }
  for (const TaskRecord& k : plan.tasks()) {
    if (k.delay != 0) fmt::format_to(in, "  {} delay {}\n", plan.text(k.name), k.delay);
    for (const auto legs : moves_of(plan.tables(), k))
      fmt::format_to(in, "  {} moves {} {}\n", plan.text(k.name),
                     plan.text(plan.bodies(k)[legs.front().body].name), move_text(legs));
  }
  if (!text.empty()) fmt::format_to(to, "\nvaried\n{}", text);
}

}  // namespace

std::string disassemble(const Plan& plan, std::uint32_t task) {
  std::string out;
  const TaskRecord& record = plan.tasks()[task];
  list_program(out, plan, record, record.program, plan.text(record.name));
  list_claim_programs(out, plan, task);
  list_later_programs(out, plan, task);
  list_skills(out, plan, task);
  list_question_programs(out, plan, task);
  return out;
}

std::string disassemble(const Plan& plan) {
  std::string out = fmt::format("plan {}\n", to_hex(plan.root()));
  fmt::format_to(
      std::back_inserter(out), "  {} tasks, {} episodes, {} programs, {} objects, {} bytes{}\n",
      plan.tasks().size(), plan.episodes().size(), plan.programs().size(), plan.objects().size(),
      plan.bytes().size(), plan.has_sources() ? "" : ", without sources");
  list_robots(out, plan);
  list_variations(out, plan);
  std::vector<std::vector<std::uint32_t>> users(plan.programs().size());
  for (std::uint32_t i = 0; i < plan.tasks().size(); ++i)
    users[plan.tasks()[i].program].push_back(i);
  for (const auto& tasks : users) {
    if (tasks.empty()) continue;  // without a task its bodies have no names
    const TaskRecord& first = plan.tasks()[tasks.front()];
    std::string names(plan.text(first.name));
    if (tasks.size() > 1) names += fmt::format(" and {} more", tasks.size() - 1);
    out += "\n";
    list_program(out, plan, first, first.program, names);
  }
  list_claim_programs(out, plan, kNone);
  list_later_programs(out, plan, kNone);
  list_skills(out, plan, kNone);
  list_question_programs(out, plan, kNone);
  return out;
}

}  // namespace probe::plan
