// The imported rules of success against the benchmark's, in its own states and in made-up ones.
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "runtime/libero/fidelity.h"
#include "runtime/libero/plain_rules.h"
#include "runtime/plan/fixtures.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"
#include "runtime/vm/judge.h"

namespace probe::libero {
namespace {

// A fixture of the scene with its joints as a tree.
struct Standing {
  std::string name;  // the benchmark's
  Pose root;
  robot::RobotModel model;
  std::vector<std::string> joints;  // in the plan's order
  std::vector<std::string> links;   // of its parts, in the plan's order
};

// A state in the plan's order of objects.
struct Judged {
  std::vector<Pose> objects;
  std::vector<double> joints;
};

class RulesOfTask {
 public:
  static Result<RulesOfTask> open(const plan::Plan& plan, const std::string& folder,
                                  std::uint32_t index, const RecordedTask& task,
                                  const PlainRules& rules) {
    RulesOfTask made(plan, index, task, rules);
    for (std::size_t i = 0; i < task.said["objects"].size(); ++i)
      made.objects_.emplace_back(
          i < made.bodies_.size() ? std::string(plan.text(made.bodies_[i].name)) : "");
    for (const auto& [name, object] : task.said["objects"].items()) {
      if (std::ranges::find(made.objects_, name) == made.objects_.end())
        return Failure{Fault::kUsage, "the import has no object `" + name + "`", task.key()};
    }
    const auto& said = task.said["fixtures"].items();
    const auto fixtures = plan.fixtures(made.scene_);
    if (fixtures.size() != said.size())
      return Failure{Fault::kUsage, "the import has other fixtures", task.key()};
    for (std::size_t f = 0; f < fixtures.size(); ++f) {
      const plan::FixtureRecord& fixture = plan.tables().fixtures[fixtures[f]];
      const std::string file = folder + "/" + std::string(plan.text(plan.assets()[fixture.urdf].path));
      PROBE_ASSIGN(robot::RobotModel model, robot::load_urdf(file));
      Standing one{said[f].first,
                   {to_vec(fixture.position), to_quat(fixture.rotation)},
                   std::move(model),
                   {},
                   {}};
      for (const plan::FixtureJointRecord& joint : plan.joints(fixture))
        one.joints.emplace_back(plan.text(joint.joint));
      for (const plan::PartRecord& part : plan.parts(fixture))
        one.links.emplace_back(plan.text(part.link));
      made.standing_.push_back(std::move(one));
    }
    return made;
  }

  std::size_t joint_count() const {
    std::size_t all = 0;
    for (const Standing& one : standing_) all += one.joints.size();
    return all;
  }
  std::size_t place_of(const std::string& object) const {
    return static_cast<std::size_t>(std::ranges::find(objects_, object) - objects_.begin());
  }

  // The goal's things and joints about where they are wanted.
  template <typename Draw>
  Judged moved(Judged state, Draw& draw) const {
    for (double& q : state.joints) {
      const double way = draw(0, 1);
      q = way < 0.4 ? draw(-0.16, 0.01) : way < 0.7 ? 0.005 : draw(-0.005, 1);
    }
    PlainState plain = to_plain(state);
    // What others are put on comes last in some goals.
    for (int again = 0; again < 2; ++again) {
      for (const PlainRules::Fact& fact : rules_.goal()) {
        if (fact.where.empty()) continue;
        const auto [middle, reach] = rules_.wanted(plain, fact);
        Vec3 p = middle;
        for (Eigen::Index i = 0; i < 3; ++i) p[i] += 0.8 * draw(-reach[i], reach[i]);
        plain.objects[fact.what].position = p;
      }
    }
    for (std::size_t i = 0; i < objects_.size(); ++i) state.objects[i] = plain.objects[objects_[i]];
    return state;
  }

  struct Verdicts {
    bool judged = false, plain = false;
  };
  // All things touching one another, or none.
  Result<Verdicts> verdicts(const Judged& state, bool touching) const {
    PROBE_ASSIGN(vm::StepSample sample, sample_of(state));
    for (std::uint16_t a = 0; touching && a < objects_.size(); ++a) {
      for (auto b = static_cast<std::uint16_t>(a + 1); b < bodies_.size(); ++b)
        sample.contacts.push_back({a, b, Vec3(0, 0, 0.01)});
    }
    std::vector<vm::BodyStart> starts(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      starts[b].position = sample.bodies[b].position;
    sample.step = 1;
    vm::Judge judge(plan_, index_);
    PROBE_TRY(judge.begin(starts));
    PROBE_TRY(judge.step(sample));
    const auto success = judge.find_metric("success");
    if (!success)
      return Failure{Fault::kUsage, "the imported task measures no `success`", task_.key()};
    return Verdicts{judge.value(*success) != 0, rules_.holds(to_plain(state), touching)};
  }

 private:
  RulesOfTask(const plan::Plan& plan, std::uint32_t index, const RecordedTask& task,
              const PlainRules& rules)
      : plan_(plan),
        index_(index),
        task_(task),
        rules_(rules),
        scene_(plan.scenes()[plan.tasks()[index].scene]),
        bodies_(plan.bodies(plan.tasks()[index])) {}

  PlainState to_plain(const Judged& state) const {
    PlainState plain;
    for (std::size_t i = 0; i < objects_.size(); ++i)
      plain.objects[objects_[i]] = state.objects[i];
    std::size_t at = 0;
    for (const Standing& one : standing_) {
      plain.fixtures[one.name] = one.root;
      for (const std::string& joint : one.joints)
        plain.joints[one.name + "_" + joint] = state.joints[at++];
    }
    return plain;
  }

  // What the judge reads, of things that stand still.
  Result<vm::StepSample> sample_of(const Judged& state) const {
    vm::StepSample sample;
    sample.bodies.resize(bodies_.size());
    sample.joints.resize(plan_.joints(scene_).size());
    for (const double q : state.joints) sample.joints.push_back({q, 0});
    const auto put = [&](std::size_t body, const Pose& pose) {
      sample.bodies[body].origin = sample.bodies[body].position = pose.position;
      sample.bodies[body].rotation = pose.rotation;
    };
    for (std::size_t i = 0; i < state.objects.size(); ++i) put(i, state.objects[i]);
    const auto is = [&](std::size_t body, plan::BodyKind kind) {
      return bodies_[body].kind == static_cast<std::uint32_t>(kind);
    };
    std::size_t body = 0, at = 0;
    for (; body < bodies_.size() && !is(body, plan::BodyKind::kPart); ++body) {
      if (is(body, plan::BodyKind::kSurface))
        put(body, {Vec3(0, 0, scene_.surface_z), Quat::Identity()});
    }
    for (const Standing& one : standing_) {
      const auto own = std::span(state.joints).subspan(at, one.joints.size());
      at += own.size();
      PROBE_ASSIGN(const robot::Tree tree, robot::Tree::create(one.model, one.joints));
      std::vector<Pose> poses(tree.link_count());
      tree.link_poses(own, poses);
      for (const std::string& name : one.links) {
        const int link = one.model.find_link(name);
        if (link < 0 || body >= bodies_.size())
          return Failure{Fault::kUsage, "no part `" + name + "`", task_.key()};
        put(body++, one.root * poses[static_cast<std::size_t>(link)]);
      }
    }
    return sample;
  }

  const plan::Plan& plan_;
  std::uint32_t index_;
  const RecordedTask& task_;
  const PlainRules& rules_;
  const plan::SceneRecord& scene_;
  std::span<const plan::BodyRecord> bodies_;
  std::vector<std::string> objects_;  // in the plan's order, the benchmark's names
  std::vector<Standing> standing_;
};

}  // namespace

Result<FidelityRow> rules_row(Imported& imported, const Records& records) {
  FidelityRow row{"rules of success",
                  "all equal",
                  "",
                  "the judge against the benchmark's rules written once more: stored and settled "
                  "states, and each stored one with the goal's things about where they are wanted, "
                  "all touching and none",
                  Held::kNo,
                  {}};
  PROBE_ASSIGN(const Json classes, records.json("libero_object_classes.json"));
  std::size_t stored = 0, settled = 0, made_up = 0, met = 0, unequal = 0;
  std::mt19937_64 draws(11);
  const auto draw = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(draws() >> 11) * 0x1p-53;
  };
  for (const RecordedTask& task : records.tasks()) {
    PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite));
    const auto index = plan->find_task(task.name());
    if (!index) {
      row.others.push_back(task.key() + ": is not in the import");
      continue;
    }
    PROBE_ASSIGN(const PlainRules rules, PlainRules::create(classes, task));
    PROBE_ASSIGN(const RulesOfTask judge,
                 RulesOfTask::open(*plan, imported.folder(), *index, task, rules));
    // Its own program saw success in none of the stored and settled states (libero_setup).
    const auto compare = [&](const Judged& state, bool may_succeed,
                             const std::string& which) -> Status {
      for (const bool touching : {false, true}) {
        PROBE_ASSIGN(const RulesOfTask::Verdicts verdicts, judge.verdicts(state, touching));
        met += verdicts.judged ? 1 : 0;
        if (verdicts.judged == verdicts.plain && (may_succeed || !verdicts.judged)) continue;
        ++unequal;
        row.others.push_back(fmt::format("{}, {}, {}: judged {}, by its own rules {}", task.key(),
                                         which, touching ? "all touching" : "nothing touching",
                                         verdicts.judged, verdicts.plain));
      }
      return {};
    };
    const plan::TaskRecord& record = plan->tasks()[*index];
    const auto episodes = plan->episodes(record);
    for (std::size_t i = 0; i < episodes.size(); ++i) {
      Judged state;
      for (const plan::PlacementRecord& placed : plan->placements(episodes[i]))
        state.objects.push_back({to_vec(placed.position), to_quat(placed.rotation)});
      state.joints =
          plan::joint_starts_of(plan->tables(), plan->scenes()[record.scene], episodes[i]);
      PROBE_TRY(compare(state, false, fmt::format("start {}", i)));
      PROBE_TRY(compare(judge.moved(state, draw), true, fmt::format("start {}, moved", i)));
      ++stored, ++made_up;
    }
    if (!records.has("libero_settled.npz")) continue;
    PROBE_ASSIGN(const std::vector<RecordedState> states, records.settled(task));
    for (std::size_t i = 0; i < states.size(); ++i) {
      Judged state;
      state.objects.resize(states[i].objects.size());
      const auto& said = task.said["objects"].items();
      for (std::size_t k = 0; k < said.size(); ++k)
        state.objects[judge.place_of(said[k].first)] = states[i].objects[k];
      state.joints = states[i].fixture_joints;
      if (state.joints.size() != judge.joint_count())
        return Failure{Fault::kUsage, "the import has other joints", task.key()};
      PROBE_TRY(compare(state, false, fmt::format("settled state {}", i)));
      ++settled;
    }
  }
  if (stored == 0) {
    row.held = Held::kNotMeasured;
    row.how = "the import has none of the recorded tasks";
    return row;
  }
  row.figure = fmt::format(
      "{} unequal; {} stored, {} settled and {} made-up states, each twice; success {} times", unequal,
      stored, settled, made_up, met);
  row.held = row.others.empty() ? Held::kYes : Held::kNo;
  return row;
}

}  // namespace probe::libero
