// An episode in its order: a connection if there is none, the transport's beginning of an episode,
// then at each act() an answer if the chunk at hand is used up, and one action of it.
#include "runtime/servers/server_policy.h"

#include <algorithm>

#include "runtime/base/sha256.h"
#include "runtime/robot/control.h"
#include "runtime/robot/robot.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/connecting.h"
#include "runtime/servers/conversion.h"
#include "runtime/servers/resize.h"

namespace probe::servers {
namespace {

Result<policy::Image> camera_image(const policy::Observation& observation,
                                   const std::string& camera) {
  if (camera.empty()) return observation.image;
  std::string known;
  for (const policy::CameraImage& shown : observation.cameras) {
    if (shown.camera == camera) return shown.image;
    known += (known.empty() ? "`" : ", `") + std::string(shown.camera) + "`";
  }
  return Failure{Fault::kPolicy,
                 "the profile wants camera `" + camera + "`, the scene has " +
                     (known.empty() ? "only its first" : known),
                 ""};
}

Result<robot::Chain> arm_of(const policy::EpisodeStart& start) {
  if (start.robot == nullptr || start.robot->model == nullptr)
    return Failure{Fault::kPolicy, "actions of joints need a robot, and there is none", ""};
  const robot::EeControlSpec& control = start.robot->control;
  return robot::Chain::create(*start.robot->model, control.tcp_link, control.arm_joints);
}

}  // namespace

Result<Request> to_request(const Profile& profile, const policy::Observation& observation) {
  Request request;
  request.prompt = to_prompt(profile, observation.prompt);
  for (const ImageRule& rule : profile.images) {
    PROBE_ASSIGN(const policy::Image image, camera_image(observation, rule.camera));
    const auto sides =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (sides == 0 || image.rgb.size() != sides * 3) {
      return Failure{Fault::kPolicy, "a picture has not width x height x 3 bytes", ""};
    }
    request.images.push_back({rule.key, to_pixels(image, rule)});
  }
  PROBE_ASSIGN(request.state, to_state(profile, observation.proprioception));
  for (const StateRule& rule : profile.more_states) {
    PROBE_ASSIGN(std::vector<double> state,
                 to_state(profile, rule.layout, observation.proprioception));
    request.more_states.emplace_back(rule.key, std::move(state));
  }
  request.proprioception = observation.proprioception;
  request.step = observation.step;
  if (names_joints(profile.action_form))
    request.action_size = observation.proprioception.arm_joints() + 1;
  return request;
}

policy::Delivery delivery_of(const Request& request) {
  Hasher pixels;
  for (const RequestImage& image : request.images)
    pixels.bytes(std::as_bytes(std::span(image.pixels.bytes)));
  return {to_hex(sha256(request.prompt)), to_hex(pixels.finish())};
}

ServerPolicy::ServerPolicy(Profile profile, std::string server,
                           std::unique_ptr<Transport> transport, policy::QueryMeter* queries)
    : given_(std::move(profile)),
      profile_(given_),
      server_(std::move(server)),
      transport_(std::move(transport)),
      queries_(queries),
      queue_(profile_) {}

ServerPolicy::~ServerPolicy() { drop(); }

Status ServerPolicy::begin(const policy::EpisodeStart& start) {
  delivery_.reset();
  queue_.clear();
  target_.reset();
  in_episode_ = false;
  if (!is_open_) PROBE_TRY(connect());
  arm_.reset();
  if (names_joints(profile_.action_form)) {
    if (auto arm = arm_of(start); arm) {
      arm_ = std::move(*arm);
    } else {
      return named(arm.failure(), server_);
    }
  }
  if (auto begun = transport_->begin_episode(start, deadlines()); !begun) {
    drop();
    return named(begun.failure(), server_);
  }
  in_episode_ = true;
  return {};
}

Result<policy::Action> ServerPolicy::act(const policy::Observation& observation) {
  if (queue_.wants_answer()) {
    if (auto asked = ask(observation); !asked) {
      drop();
      return named(asked.failure(), server_);
    }
  }
  // The controller's own law: its target starts where the tool is and moves by each action.
  const policy::Proprioception& measured = observation.proprioception;
  const Pose& tool = measured.tcp_in_base;
  if (!target_) target_ = tool;
  const std::span<const double> joints(measured.joints.data(), measured.arm_joints());
  auto action = to_action(profile_, queue_.take(),
                          {*target_, tool.position, joints, arm_ ? &*arm_ : nullptr});
  if (!action) return named(action.failure(), server_);
  const policy::Action& a = *action;
  target_ = robot::moved_target(*target_, tool.position, {a[0], a[1], a[2]}, {a[3], a[4], a[5]});
  return action;
}

void ServerPolicy::end(const policy::EpisodeEnd& end) {
  if (!in_episode_) return;
  in_episode_ = false;
  const auto ended = transport_->end_episode(end, deadlines());
  if (!ended || profile_.connection == ConnectionUse::kPerEpisode) drop();
}

Status ServerPolicy::connect() {
  has_answered_ = false;
  PROBE_TRY(open_patiently(*transport_, given_, server_, &profile_));
  is_open_ = true;
  notes_ = transport_->notes();
  for (std::string& note : notes_) note = without_key(note);
  queue_ = ChunkQueue(profile_);
  return {};
}

Status ServerPolicy::ask(const policy::Observation& observation) {
  if (!in_episode_) return Failure{Fault::kPolicy, "the connection was lost in this episode", ""};
  PROBE_ASSIGN(const Request request, to_request(profile_, observation));
  if (!delivery_) delivery_ = delivery_of(request);
  auto answer = [&] {
    const policy::QueryMeter::InFlight flight(queries_);
    return transport_->ask(request, deadlines());
  }();
  if (!answer) return answer.failure();
  has_answered_ = true;
  return queue_.put(std::move(*answer));
}

Deadlines ServerPolicy::deadlines() const {
  return {to_duration(profile_.connect_s),
          to_duration(has_answered_ ? profile_.answer_s
                                    : std::max(profile_.first_s, profile_.answer_s))};
}

void ServerPolicy::drop() {
  if (is_open_) transport_->close();
  is_open_ = in_episode_ = false;
}

}  // namespace probe::servers
