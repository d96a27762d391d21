// The arm and its hand under recorded actions, and the torques of recorded states.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "runtime/libero/fidelity.h"
#include "runtime/robot/osc.h"

namespace probe::libero {
namespace {

constexpr std::size_t kArm = 7;

Mat3 rows_of(const std::vector<double>& numbers) {
  Mat3 out;
  for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = numbers[static_cast<std::size_t>(i)];
  return out;
}

// A substep for which Jacobian and mass matrix were written out.
struct Substep {
  robot::Dynamics state;
  Vec3 goal;
  Mat3 goal_axes;
  std::vector<double> torques;  // N m, not clipped yet
};

Result<Substep> substep_of(const Json& r, const std::string& where) {
  Substep out;
  robot::Dynamics& d = out.state;
  PROBE_ASSIGN(const auto q, numbers(r, "q", 7, where));
  PROBE_ASSIGN(const auto u, numbers(r, "dq", 7, where));
  PROBE_ASSIGN(const auto bias, numbers(r, "bias", 7, where));
  PROBE_ASSIGN(const auto j, numbers(r, "J", 42, where));
  PROBE_ASSIGN(const auto m, numbers(r, "M", 49, where));
  PROBE_ASSIGN(const auto place, numbers(r, "ee_pos", 3, where));
  PROBE_ASSIGN(const auto velocity, numbers(r, "ee_vel", 3, where));
  PROBE_ASSIGN(const auto spin, numbers(r, "ee_omega", 3, where));
  PROBE_ASSIGN(const auto axes, numbers(r, "ee_mat", 9, where));
  PROBE_ASSIGN(const auto goal, numbers(r, "goal_pos", 3, where));
  PROBE_ASSIGN(const auto goal_axes, numbers(r, "goal_mat", 9, where));
  PROBE_ASSIGN(out.torques, numbers(r, "tau", 7, where));
  d.q.resize(7), d.u.resize(7), d.bias.resize(7), d.mass.resize(7, 7), d.jacobian.resize(6, 7);
  for (int i = 0; i < 7; ++i) {
    const auto at = static_cast<std::size_t>(i);
    d.q[i] = q[at], d.u[i] = u[at], d.bias[i] = bias[at];
    for (std::size_t k = 0; k < 7; ++k) d.mass(i, static_cast<int>(k)) = m[at * 7 + k];
    for (std::size_t k = 0; k < 6; ++k) d.jacobian(static_cast<int>(k), i) = j[k * 7 + at];
  }
  d.position = Vec3(place.data());
  d.velocity = Vec3(velocity.data());
  d.spin = Vec3(spin.data());
  d.axes = rows_of(axes);
  out.goal = Vec3(goal.data());
  out.goal_axes = rows_of(goal_axes);
  return out;
}

}  // namespace

Result<FidelityRow> torques_row(Imported& imported, const Records& records) {
  constexpr double kBar = 1e-9;  // N m
  FidelityRow row{"torques of given states",
                  "1e-9 N m",
                  "",
                  "osc_pose of the import's robot in recorded substeps with their J and M",
                  Held::kNo,
                  {}};
  std::size_t compared = 0;
  double worst = 0;
  for (const RecordedTask& task : records.tasks()) {
    const std::string file = "reference/osc_unit_" + task.key() + ".json";
    if (!records.has(file)) continue;
    PROBE_ASSIGN(const Json all, records.json(file));
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), {.pictures = false}));
    const auto* law = std::get_if<robot::OscPose>(&stage->robot().law);
    if (law == nullptr)
      return Failure{Fault::kUsage, "the import's robot is not under osc_pose", task.key()};
    PROBE_ASSIGN(
        robot::OscPoseController osc,
        robot::OscPoseController::create(*stage->robot().model, stage->robot().control, *law));
    if (!all.is_array()) return Failure{Fault::kUsage, "expected an array of substeps", file};
    for (const Json& r : all) {
      if (!r.is_object() || r.find("J") == nullptr || !r["J"].is_array()) continue;
      PROBE_ASSIGN(const Substep substep, substep_of(r, file));
      robot::ControlState saved;
      saved.target = {substep.goal, Quat(substep.goal_axes).normalized()};
      saved.joint_targets = {0, 0};
      PROBE_TRY(osc.restore(saved));
      std::array<double, 9> tau{};
      osc.efforts(substep.state, tau);
      for (std::size_t i = 0; i < kArm; ++i) {
        const double limit = i < 5 ? 80 : 12;
        worst = worse(worst, std::abs(tau[i] - std::clamp(substep.torques[i], -limit, limit)));
      }
      ++compared;
    }
  }
  if (compared == 0) {
    row.how = "the records have no reference/osc_unit_*.json";
    row.held = Held::kNotMeasured;
    return row;
  }
  row.figure = fmt::format("{:.1g} N m in {} substeps", worst, compared);
  row.held = worst <= kBar ? Held::kYes : Held::kNo;
  return row;
}

namespace {

struct Deviation {
  double joint = 0, tool = 0, finger = 0;  // rad, m, m
  void take(const Deviation& other) {
    joint = worse(joint, other.joint);
    tool = worse(tool, other.tool);
    finger = worse(finger, other.finger);
  }
};

struct Followed {
  Deviation off;
  std::size_t steps = 0, touching = 0;  // in which the arm touches something
  double fixture = 0;                   // m or rad, of joints of fixtures at the end
  std::size_t fixture_joints = 0;
};

bool touches(const stage::Stage& stage, const plan::Plan& plan) {
  const auto bodies = plan.bodies(plan.tasks()[stage.task()]);
  return std::ranges::any_of(stage.sample().contacts, [&](const vm::ContactSample& contact) {
    const auto is_arm = [&](std::uint16_t body) {
      return bodies[body].kind == static_cast<std::uint32_t>(plan::BodyKind::kLink);
    };
    return is_arm(contact.a) || is_arm(contact.b);
  });
}

// The recorded actions from the recorded start, which is the task's first.
Result<Followed> follow(Imported& imported, const Records& records, const RecordedTask& task) {
  const std::string file = "reference/" + task.key() + "_osc.csv";
  PROBE_ASSIGN(const std::string text, records.text(file));
  PROBE_ASSIGN(const RecordedTable table, read_table(text, file));
  PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite));
  PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), {.pictures = false}));
  const auto* law = std::get_if<robot::OscPose>(&stage->robot().law);
  if (law == nullptr)
    return Failure{Fault::kUsage, "the import's robot is not under osc_pose", task.key()};
  PROBE_ASSIGN(const std::size_t step_at, table.column("step"));
  PROBE_ASSIGN(const std::size_t action_at, table.column("a0"));
  PROBE_ASSIGN(const std::size_t q_at, table.column("q1"));
  PROBE_ASSIGN(const std::size_t finger_at, table.column("f1"));
  PROBE_ASSIGN(const std::size_t tool_at, table.column("tcp_x"));
  if (std::max({action_at + 7, q_at + kArm, finger_at + 2, tool_at + 3}) > table.names.size())
    return Failure{Fault::kUsage, "the table's columns are in another order", file};
  PROBE_TRY(stage->reset(0));
  const int waited = static_cast<int>(plan->tasks()[stage->task()].idle);
  Followed followed;
  for (const std::vector<double>& row : table.rows) {
    const int step = static_cast<int>(row[step_at]);
    if (step < waited - 1) continue;
    if (step >= waited) {
      policy::Action action = policy::Action::zeros(7);
      for (std::size_t i = 0; i < 6; ++i) action[i] = row[action_at + i] * law->output[i];
      action[6] = -row[action_at + 6];  // there +1 closes
      PROBE_TRY(stage->step(action));
    }
    followed.touching += touches(*stage, *plan) ? 1 : 0;
    Deviation off;
    for (std::size_t i = 0; i < kArm; ++i)
      off.joint = worse(off.joint, std::abs(stage->q()[i] - row[q_at + i]));
    off.finger = worse(std::abs(stage->q()[7] - row[finger_at]),
                       std::abs(stage->q()[8] + row[finger_at + 1]));
    off.tool =
        (stage->sample().tcp - Vec3(row[tool_at], row[tool_at + 1], row[tool_at + 2])).norm();
    followed.off.take(off);
    ++followed.steps;
  }
  // Joints of fixtures where the record ends.
  const std::string end = "reference/" + task.key() + "_state.json";
  if (!records.has(end)) return followed;
  PROBE_ASSIGN(const Json said, records.json(end));
  PROBE_ASSIGN(const auto last, numbers(said, "state_t70", 0, end));
  std::size_t at = 10 + 7 * task.said["objects"].size();
  const auto joints = stage->q().subspan(kArm + 2);
  for (std::size_t i = 0; i < joints.size() && at + i < last.size(); ++i, ++followed.fixture_joints)
    followed.fixture = worse(followed.fixture, std::abs(joints[i] - last[at + i]));
  return followed;
}

}  // namespace

Result<std::vector<FidelityRow>> steps_rows(Imported& imported, const Records& records) {
  constexpr double kJoint = 1e-3, kTool = 5e-4, kFinger = 3e-4, kFixture = 2e-3;
  Deviation free;
  double fixture = 0;
  std::size_t runs = 0, free_runs = 0, steps = 0, joints = 0;
  std::vector<std::string> others, moved;
  for (const RecordedTask& task : records.tasks()) {
    if (!records.has("reference/" + task.key() + "_osc.csv")) continue;
    PROBE_ASSIGN(const Followed one, follow(imported, records, task));
    ++runs;
    fixture = worse(fixture, one.fixture);
    joints += one.fixture_joints;
    if (!(one.fixture <= kFixture))
      moved.push_back(fmt::format("{}: {:.2g} m or rad", task.key(), one.fixture));
    if (one.touching == 0) {
      ++free_runs;
      steps += one.steps;
      free.take(one.off);
    }
    if (one.touching > 0 || !(one.off.joint <= kJoint) || !(one.off.tool <= kTool))
      others.push_back(fmt::format(
          "{}: joints {:.3g} mrad, tool {:.3g} mm, fingers {:.3g} mm; the arm touches something in "
          "{} of {} steps",
          task.key(), 1e3 * one.off.joint, 1e3 * one.off.tool, 1e3 * one.off.finger, one.touching,
          one.steps));
  }
  const std::string over = fmt::format("{} steps of {} runs of {}", steps, free_runs, runs);
  // A row of nothing is not measured, and says what is lacking.
  const auto row = [](FidelityRow measured, std::size_t compared, bool is_held,
                      const char* lacking) {
    measured.held = is_held ? Held::kYes : Held::kNo;
    if (compared > 0) return measured;
    measured.figure.clear();
    measured.how = lacking;
    measured.held = Held::kNotMeasured;
    return measured;
  };
  const char* const kNoFree = "the records have no run in which the arm touches nothing";
  std::vector<FidelityRow> rows;
  rows.push_back(
      row({"arm over the recorded steps", "1 mrad, 0.5 mm",
           fmt::format("{:.2g} mrad, {:.2g} mm in {}", 1e3 * free.joint, 1e3 * free.tool, over),
           "imported scenes under the recorded actions, runs in which it touches nothing",
           Held::kNo, std::move(others)},
          steps, free.joint <= kJoint && free.tool <= kTool, kNoFree));
  rows.push_back(row({"fingers, closing freely",
                      "0.3 mm",
                      fmt::format("{:.2g} mm in {}", 1e3 * free.finger, over),
                      "the same runs",
                      Held::kNo,
                      {}},
                     steps, free.finger <= kFinger, kNoFree));
  rows.push_back(row({"drawers, doors and knobs", "2 mm, 2 mrad",
                      fmt::format("{:.2g} m or rad in {} joints", fixture, joints),
                      "where the recorded runs end, those in which the arm pushes as well",
                      Held::kNo, std::move(moved)},
                     joints, fixture <= kFixture,
                     "the records say of no joint of a fixture where its run ends"));
  return rows;
}

}  // namespace probe::libero
