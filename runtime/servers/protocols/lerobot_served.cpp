// LeRobot's protocol from the server's side, see lerobot.cpp: one place for an observation, and
// nothing for whoever asks while it is empty and stays so.
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "runtime/servers/protocols/lerobot_messages.h"
#include "runtime/servers/protocols/served_sides.h"

namespace probe::servers {
namespace {

constexpr double kStepTime = 1.0 / 30;        // s, what its servers count by
constexpr std::chrono::seconds kPatience{2};  // for an observation: their obs_queue_timeout

class LeRobotSpeaker final : public wire::Speaker {
 public:
  explicit LeRobotSpeaker(const ServeOptions& options)
      : chunk_(options.chunk), policy_(options.policy()) {}

  Reply answer(const wire::Frame& asked) override {
    auto message = [&]() -> Result<wire::Bytes> {
      PROBE_ASSIGN(const wire::GrpcCall call, wire::call_of(asked));
      return said(call);
    }();
    if (message) return {{wire::Frame{false, std::move(*message)}}};
    return {{}, "Exception calling application: " + message.failure().message};
  }

 private:
  Result<wire::Bytes> said(const wire::GrpcCall& call) {
    if (call.method == lerobot::kReady) {
      const std::scoped_lock lock(working_, place_);
      observation_.reset();
      ++readied_;
      arrived_.notify_all();
      policy_->reset();
      return wire::Bytes{};
    }
    if (call.method == lerobot::kSendPolicy) {
      PROBE_ASSIGN(auto setup, lerobot::setup_of(call));
      const std::lock_guard lock(place_);
      setup_ = std::move(setup);
      return wire::Bytes{};
    }
    if (call.method == lerobot::kSendObservations) {
      PROBE_ASSIGN(auto observation, lerobot::observation_of(call));
      const std::lock_guard lock(place_);
      observation_ = std::move(observation);
      arrived_.notify_one();
      return wire::Bytes{};
    }
    if (call.method == lerobot::kGetActions) return actions();
    return bad("Method not found!");
  }

  Result<wire::Bytes> actions() {
    std::unique_lock place(place_);
    // Of a place that Ready empties for another one nothing comes, as there.
    arrived_.wait_for(place, kPatience,
                      [&, before = readied_] { return observation_ || readied_ != before; });
    if (!observation_ || !setup_) return wire::Bytes{};
    const lerobot::Observation seen = std::move(*observation_);
    observation_.reset();
    const int most = std::min(chunk_, setup_->chunk);
    place.unlock();
    PROBE_ASSIGN(wire::Array picture, first_picture(seen.content));
    PROBE_ASSIGN(std::string words, text_at(seen.content, "task"));
    const std::lock_guard working(working_);
    PROBE_ASSIGN(const auto answered,
                 policy_->answer({std::move(picture), std::move(words)}, most));
    std::vector<lerobot::TimedAction> timed;
    for (const policy::Action& action : answered) {
      const auto count = static_cast<double>(timed.size());
      // In double precision, which a tensor may have, so that nothing is lost.
      timed.push_back({seen.timestamp + count * kStepTime,
                       seen.timestep + static_cast<std::int64_t>(timed.size()),
                       wire::array_f64({7}, {action.begin(), action.end()})});
    }
    return lerobot::actions_message(timed);
  }

  int chunk_;
  std::mutex working_;  // policy_
  std::unique_ptr<ServedPolicy> policy_;
  std::mutex place_;  // what is below
  std::condition_variable arrived_;
  int readied_ = 0;
  std::optional<lerobot::PolicySetup> setup_;
  std::optional<lerobot::Observation> observation_;
};

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve_lerobot(const ServeOptions& options) {
  return wire::listen_grpc_at_once(options.address, options.port,
                                   [options] { return std::make_unique<LeRobotSpeaker>(options); });
}

}  // namespace probe::servers
