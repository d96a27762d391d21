// An episode in its order: a connection if there is none, the transport's beginning of an episode,
// then at each act() an answer if the chunk at hand is used up, and one action of it.
#include "runtime/servers/server_policy.h"

#include <algorithm>
#include <system_error>

#include "runtime/base/sha256.h"
#include "runtime/robot/control.h"
#include "runtime/robot/robot.h"
#include "runtime/servers/api_key.h"
#include "runtime/servers/connecting.h"
#include "runtime/servers/conversion.h"
#include "runtime/servers/meaning.h"
#include "runtime/servers/protocol.h"
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
  const Pose base = observation.privileged == nullptr ? Pose{} : observation.privileged->base;
  PROBE_ASSIGN(request.state, to_state(profile, observation.proprioception, base));
  for (const StateRule& rule : profile.more_states) {
    PROBE_ASSIGN(std::vector<double> state,
                 to_state(profile, rule.layout, observation.proprioception, base));
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
                           std::unique_ptr<Transport> transport, policy::QueryMeter* queries,
                           std::shared_ptr<Identity> identity)
    : given_(std::move(profile)),
      profile_(given_),
      server_(std::move(server)),
      transport_(std::move(transport)),
      queries_(queries),
      identity_(std::move(identity)),
      queue_(profile_) {}

ServerPolicy::~ServerPolicy() { drop(); }

Status ServerPolicy::begin(const policy::EpisodeStart& start) {
  delivery_.reset();
  queue_.clear();
  target_.reset();
  in_episode_ = false;
  spoiled_.reset();
  is_earlier_spoiled_ = false;
  asked_ = 0;
  if (is_exchanged_unseen() && identity_->is_due()) is_shown_ = false;
  PROBE_TRY(is_open_ ? show_who_answers() : connect());
  arm_.reset();
  space_ = {};
  sticky_ = StickyGripper(profile_.action_sticky, profile_.action_sticky_steps);
  if (start.robot != nullptr) {
    space_ = robot::action_space_of(*start.robot);
    PROBE_TRY(
        check_form(profile_, profile_.action_form, robot::row_of(start.robot->law).kind, server_));
  }
  if (names_joints(profile_.action_form)) {
    if (auto arm = arm_of(start); arm) {
      arm_ = std::move(*arm);
    } else {
      return named(arm.failure(), server_);
    }
  }
  if (auto begun = transport_->begin_episode(start, deadlines()); !begun) {
    note_unasked(begun.failure());
    drop();
    return named(begun.failure(), server_);
  }
  in_episode_ = true;
  return {};
}

Result<policy::Action> ServerPolicy::act(const policy::Observation& observation) {
  // What was answered to another instruction is not done under this one.
  if (observation.prompt != instruction_) queue_.clear();
  if (queue_.wants_answer()) {
    if (auto asked = ask_and_wait(observation); !asked) {
      note_unasked(asked.failure());
      drop();
      return named(asked.failure(), server_);
    }
  }
  auto action = convert(queue_.take(), observation);
  if (action) done(*action, observation);
  return action;
}

// The controller's own law: its target starts where the tool is and moves by each action.
Result<policy::Action> ServerPolicy::convert(const RawAction& said,
                                             const policy::Observation& now) {
  const policy::Proprioception& measured = now.proprioception;
  const Pose& tool = measured.tcp_in_base;
  if (!target_) target_ = tool;
  const std::span<const double> joints(measured.joints.data(), measured.arm_joints());
  auto action = to_action(profile_, said,
                          {*target_, tool.position, joints, arm_ ? &*arm_ : nullptr, &space_});
  if (!action) return named(action.failure(), server_);
  if (profile_.action_sticky != StickyRule::kNone) {
    action->gripper() = sticky_.step((action->gripper() + 1) / 2);
  }
  return action;
}

void ServerPolicy::done(const policy::Action& a, const policy::Observation& now) {
  if (space_.is_of_joints()) return;
  const Pose& tool = now.proprioception.tcp_in_base;
  if (!target_) target_ = tool;
  target_ = robot::moved_target(*target_, tool.position, {a[0], a[1], a[2]}, {a[3], a[4], a[5]});
}

Status ServerPolicy::ask(const policy::Observation& seen,
                         policy::LiveClock::time_point useful_until) {
  using policy::LiveClock;
  Deadlines times = deadlines();
  if (useful_until < LiveClock::time_point::max()) {
    // A server that is a little late is free again when the next episode asks it; for one that
    // hangs no episode stands still.
    const auto left = std::chrono::ceil<wire::Duration>(useful_until - LiveClock::now());
    times.answer = std::min(times.answer, std::max(left, wire::Duration(0)) + times.connect);
  }
  auto request = next_request(seen);
  if (!request) {
    drop();
    return named(request.failure(), server_);
  }
  const auto asking = [this, asked = std::move(*request), times]() -> Result<Answer> {
    const policy::QueryMeter::InFlight flight(queries_);
    try {
      PROBE_ASSIGN(auto actions, transport_->ask(asked, times));
      return Answer{std::move(actions), policy::LiveClock::now()};
    } catch (const std::exception& error) {
      return bad(std::string("a question: ") + error.what());  // and the connection is dropped
    }
  };
  asked_at_ = LiveClock::now();
  try {
    question_ = std::async(std::launch::async, asking);
  } catch (const std::system_error&) {
    return named(bad("the system gives no thread to ask on"), server_);
  }
  return {};
}

Result<std::optional<policy::Answerer::Answer>> ServerPolicy::wait(
    policy::LiveClock::time_point until) {
  // Far away is for good: the question has a limit of its own.
  const bool is_bounded = until < policy::LiveClock::time_point::max();
  if (is_bounded && question_.wait_until(until) != std::future_status::ready)
    return std::optional<Answer>();
  auto answer = question_.get();
  const Status fits = answer ? queue_.check(answer->actions) : Status(answer.failure());
  if (!fits) {
    note_unasked(fits.failure());
    drop();
    return named(fits.failure(), server_);
  }
  last_took_ = std::chrono::ceil<wire::Duration>(policy::LiveClock::now() - asked_at_);
  note_answer();
  last_length_ = answer->actions.size();
  return std::optional(std::move(*answer));
}

int ServerPolicy::steps_between(int /*asked*/) const {
  if (profile_.ensemble == Ensemble::kTemporal) return 1;
  return profile_.chunk_use > 0 ? profile_.chunk_use : static_cast<int>(last_length_);
}

std::optional<double> ServerPolicy::ensemble_ratio() const {
  if (profile_.ensemble != Ensemble::kTemporal) return std::nullopt;
  return profile_.ensemble_ratio;
}

void ServerPolicy::forget_question() {
  if (!question_.valid()) return;
  const auto answer = question_.get();
  // A question that failed has left the connection in an unknown state.
  if (answer) return;
  drop();
}

void ServerPolicy::end(const policy::EpisodeEnd& end) {
  forget_question();
  if (!in_episode_) return;
  in_episode_ = false;
  // An answer that is one too old leaves one behind, which comes as late as an answer does.
  constexpr wire::Duration kLeast{40}, kMost{2000};
  Status ended = transport_->listen(std::clamp(last_took_ * 3 / 2, kLeast, kMost));
  if (ended) ended = transport_->end_episode(end, deadlines());
  if (!ended) {
    // Not of a connection that was lost: the episode was over.
    if (ended.failure().code == Fault::kAnswered) spoiled_ = named(ended.failure(), server_);
    return drop();
  }
  if (profile_.connection == ConnectionUse::kPerEpisode) hang_up();
}

Status ServerPolicy::connect() {
  has_answered_ = false;
  PROBE_ASSIGN(const int attempts, open_patiently(*transport_, given_, server_, &profile_));
  if (attempts > 1) is_shown_ = false;  // nobody was there for a while
  is_open_ = true;
  notes_ = transport_->notes();
  for (std::string& note : notes_) note = without_key(note);
  queue_ = ChunkQueue(profile_);
  if (!identity_ || !is_shown_) return show_who_answers();
  return kept(identity_->check_hello(*transport_));
}

// A connection on which something failed is dropped.
Status ServerPolicy::kept(const Status& fine) {
  if (fine) return {};
  drop();
  return named(fine.failure(), server_);
}

Status ServerPolicy::show_who_answers() {
  if (!identity_ || is_shown_) return {};
  PROBE_TRY(kept(check_identity()));
  is_shown_ = true;
  return {};
}

Status ServerPolicy::check_identity() {
  PROBE_TRY(identity_->check(*transport_, profile_));
  if (profile_.connection != ConnectionUse::kPerEpisode) return {};
  // Its server knows an episode by its connection: the question is no part of one.
  transport_->close();
  PROBE_ASSIGN(const int attempts, open_patiently(*transport_, given_, server_, &profile_));
  return attempts == 1 ? Status()
                       : bad("the server went away when it had just been asked who it is");
}

Result<Request> ServerPolicy::next_request(const policy::Observation& observation) {
  if (!in_episode_) return Failure{Fault::kPolicy, "the connection was lost in this episode", ""};
  PROBE_ASSIGN(Request request, to_request(profile_, observation));
  // Another instruction is a full reset of the policies that have such a rule.
  if (instruction_ != observation.prompt) sticky_.reset();
  instruction_ = observation.prompt;
  if (!delivery_) delivery_ = delivery_of(request);
  return request;
}

Status ServerPolicy::ask_and_wait(const policy::Observation& observation) {
  PROBE_ASSIGN(const Request request, next_request(observation));
  const auto since = policy::LiveClock::now();
  auto answer = [&] {
    const policy::QueryMeter::InFlight flight(queries_);
    return transport_->ask(request, deadlines());
  }();
  if (!answer) return answer.failure();
  last_took_ = std::chrono::ceil<wire::Duration>(policy::LiveClock::now() - since);
  note_answer();
  return queue_.put(std::move(*answer));
}

void ServerPolicy::note_answer() {
  ++asked_;
  has_answered_ = true;
  if (is_exchanged_unseen()) identity_->note_answer();
}

bool ServerPolicy::is_exchanged_unseen() const {
  return identity_ && row_of(profile_.protocol).is_exchanged_unseen;
}

// What lies there before an episode's first answer is left of the episode before.
void ServerPolicy::note_unasked(const Failure& failure) {
  is_earlier_spoiled_ = asked_ == 0 && failure.message.find(kUnasked) != std::string::npos;
}

Deadlines ServerPolicy::deadlines() const {
  return {to_duration(profile_.connect_s),
          to_duration(has_answered_ ? profile_.answer_s
                                    : std::max(profile_.first_s, profile_.answer_s))};
}

// What was lost may have been anybody's since.
void ServerPolicy::drop() {
  is_shown_ = false;
  hang_up();
}

void ServerPolicy::hang_up() {
  if (question_.valid()) question_.wait();
  question_ = {};
  if (is_open_) transport_->close();
  is_open_ = in_episode_ = false;
}

}  // namespace probe::servers
