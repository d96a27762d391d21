// vla-eval's protocol 1 from the server's side, see vlaeval.cpp. Pictures are read raw: whoever
// sends them as PNG is told so.
#include "runtime/base/clock.h"
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/servers/protocols/vlaeval_messages.h"

namespace probe::servers {
namespace {

wire::Value part_of_spec(const char* name, int dims, const char* format) {
  return wire::Map{{"name", name}, {"dims", dims}, {"format", format}};
}

class VlaEvalSpeaker final : public wire::Speaker {
 public:
  explicit VlaEvalSpeaker(const ServeOptions& options) : policy_(options.policy()) {}

  Reply answer(const wire::Frame& asked) override {
    const auto message = vlaeval::from_bytes(asked.bytes);
    if (!message) return {{}, message.failure().message};
    if (message->type == "hello") return said("hello", hello(), message->seq);
    if (message->type == "episode_start") policy_->reset();
    if (message->type != "observation") return {};
    auto action = [&]() -> Result<wire::Value> {
      const wire::Value* images = message->payload.find("images");
      PROBE_ASSIGN(wire::Array picture, first_picture(images == nullptr ? wire::Value() : *images));
      PROBE_ASSIGN(std::string words, text_at(message->payload, "task_description"));
      PROBE_ASSIGN(const auto actions, policy_->answer({std::move(picture), std::move(words)}, 1));
      const std::vector<double> numbers(actions.front().begin(), actions.front().end());
      return wire::Value(wire::Map{{"actions", wire::array_f64({7}, numbers)}});
    }();
    if (action) return said("action", std::move(*action), message->seq);
    return said("error", wire::Map{{"error", "observation_failed: " + action.failure().message}},
                message->seq);
  }

 private:
  static wire::Value hello() {
    return wire::Map{
        {"harness_version", "vlaprobe"},
        {"protocol_version", 1},
        {"model_server", "vlaprobe serve"},
        {"capabilities", wire::Map{}},
        {"observation_params", wire::Map{{"send_state", false}}},
        {"action_spec", wire::Map{{"position", part_of_spec("position", 3, "delta_xyz")},
                                  {"rotation", part_of_spec("rotation", 3, "axis_angle")},
                                  {"gripper", part_of_spec("gripper", 1, "raw")}}}};
  }
  static Reply said(std::string type, wire::Value payload, std::int64_t seq) {
    return {{wire::Frame{
        false, vlaeval::to_bytes({std::move(type), std::move(payload), seq}, unix_seconds())}}};
  }

  std::unique_ptr<ServedPolicy> policy_;
};

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve_vlaeval(const ServeOptions& options) {
  return wire::listen_websocket(options.address, options.port,
                                [options] { return std::make_unique<VlaEvalSpeaker>(options); });
}

}  // namespace probe::servers
