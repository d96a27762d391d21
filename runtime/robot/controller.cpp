#include "runtime/robot/controller.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/base/check.h"

namespace probe::robot {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace

Result<Controller> Controller::create(const RobotModel& model, const EeControlSpec& spec,
                                      const Law& law) {
  // The law's own controller first: its failures name what is wrong best.
  std::vector<Any> made;
  PROBE_TRY(std::visit(
      Overloaded{[&](const EeDeltaPose&) -> Status {
                   PROBE_ASSIGN(auto one, EeDeltaPoseController::create(model, spec));
                   made.emplace_back(std::move(one));
                   return {};
                 },
                 [&](const OscPose& osc) -> Status {
                   PROBE_ASSIGN(auto one, OscPoseController::create(model, spec, osc));
                   made.emplace_back(std::move(one));
                   return {};
                 },
                 [&](const EeDeltaInterpolated& paths) -> Status {
                   PROBE_ASSIGN(auto one, InterpolatedController::create(model, spec, paths));
                   made.emplace_back(std::move(one));
                   return {};
                 },
                 [&](const auto& of_joints) -> Status {
                   PROBE_ASSIGN(auto one, JointController::create(model, spec, of_joints));
                   made.emplace_back(std::move(one));
                   return {};
                 }},
      law));
  PROBE_ASSIGN(Chain chain, Chain::create(model, spec.tcp_link, spec.arm_joints));
  Controller controller(row_of(law), std::move(chain), std::move(made.front()));
  PROBE_ASSIGN(controller.range_, finger_range(model, spec.finger_joints, opens_up(spec)));
  controller.joints_ = spec.arm_joints.size() + spec.finger_joints.size();
  controller.tcp_link_ = spec.tcp_link;
  return controller;
}

void Controller::reset(std::span<const double> q) {
  std::visit(
      Overloaded{[](OscPoseController& osc) { osc.reset(); }, [&](auto& other) { other.reset(q); }},
      law_);
}

Status Controller::begin(std::span<const double> action, std::span<const double> measured_q,
                         std::span<const double> measured_u, int substeps) {
  if (action.size() != action_size()) {
    return Failure{Fault::kPolicy,
                   fmt::format("an action of {} numbers, `{}` wants {}", action.size(), row_->word,
                               action_size()),
                   ""};
  }
  return std::visit(
      Overloaded{[&](EeDeltaPoseController& ee) -> Status {
                   ToolAction seven{};
                   std::copy(action.begin(), action.end(), seven.begin());
                   PROBE_TRY(ee.targets(seven, measured_q));
                   return {};
                 },
                 [&](InterpolatedController& paths) -> Status {
                   ToolAction seven{};
                   std::copy(action.begin(), action.end(), seven.begin());
                   return paths.begin(seven, measured_q, measured_u, substeps);
                 },
                 [&](OscPoseController& osc) -> Status { return osc.begin(action, substeps); },
                 [&](JointController& joints) -> Status {
                   PROBE_TRY(joints.targets(action, measured_q));
                   return {};
                 }},
      law_);
}

std::span<const double> Controller::targets() const {
  return std::visit(
      Overloaded{[](const OscPoseController&) { return std::span<const double>(); },
                 [](const auto& other) { return std::span<const double>(other.last()); }},
      law_);
}

void Controller::next() {
  InterpolatedController* paths = std::get_if<InterpolatedController>(&law_);
  PROBE_CHECK(paths != nullptr, "a law that reads states");
  paths->next();
}

std::span<const double> Controller::target_speeds() const {
  const InterpolatedController* paths = std::get_if<InterpolatedController>(&law_);
  return paths == nullptr ? std::span<const double>() : paths->target_speeds();
}

std::span<const double> Controller::believed() const {
  const OscPoseController* osc = std::get_if<OscPoseController>(&law_);
  return osc == nullptr ? std::span<const double>() : osc->believed();
}

void Controller::efforts(const Dynamics& now, std::span<double> out) {
  OscPoseController* osc = std::get_if<OscPoseController>(&law_);
  PROBE_CHECK(osc != nullptr, "a law that reads dynamics");
  osc->efforts(now, out);
}

ControlState Controller::save() const {
  return std::visit([](const auto& one) { return one.save(); }, law_);
}

Status Controller::restore(const ControlState& state) {
  return std::visit([&](auto& one) { return one.restore(state); }, law_);
}

Pose Controller::tcp_pose(std::span<const double> q) const {
  return chain_.pose(q.first(chain_.joint_count()));
}

double Controller::openness(std::span<const double> q) const {
  return range_.openness(q.subspan(chain_.joint_count()));
}

}  // namespace probe::robot
