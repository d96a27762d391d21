// openpi's protocol and its dialects from the server's side, see the clients' files.
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/wire/msgpack.h"

namespace probe::servers {
namespace {

wire::Frame packed(const wire::Value& value) {
  return {false, wire::to_msgpack(value, wire::ArrayStyle::kBinKeys)};
}

// Greets with metadata, and ends the connection with a text where something fails, as these servers
// end it with a traceback.
class OpenpiSpeaker : public wire::Speaker {
 public:
  explicit OpenpiSpeaker(const ServeOptions& options)
      : options_(options), policy_(options.policy()) {}

  std::vector<wire::Frame> greet() override { return {packed(metadata())}; }

  Reply answer(const wire::Frame& asked) override {
    auto frame = [&]() -> Result<wire::Frame> {
      PROBE_ASSIGN(const wire::Value request, wire::from_msgpack(asked.bytes));
      return said(request);
    }();
    if (frame) return {{std::move(*frame)}};
    return {{wire::text_frame("vlaprobe: " + frame.failure().message)},
            "Internal server error. Traceback included in previous frame."};
  }

 protected:
  virtual wire::Value metadata() const { return wire::Map{}; }
  virtual Result<wire::Frame> said(const wire::Value& request) {
    const wire::Value* batch = request.find("batch");
    if (const auto* items = batch == nullptr ? nullptr : batch->as<wire::List>()) {
      PROBE_ASSIGN(const auto all, act_all(*items, "prompt"));
      wire::List answers;
      for (const auto& actions : all)
        answers.emplace_back(wire::Map{{"actions", actions_array(actions)}});
      return packed(wire::Map{{"batch", std::move(answers)}});
    }
    PROBE_ASSIGN(const auto actions, act(request, "prompt"));
    return packed(wire::Map{{"actions", actions_array(actions)}});
  }

  Result<std::vector<policy::Action>> act(const wire::Value& request, std::string_view words) {
    PROBE_ASSIGN(const Asked asked, asked_of(request, words));
    return policy_->answer(asked, options_.chunk);
  }
  Result<std::vector<std::vector<policy::Action>>> act_all(const wire::List& requests,
                                                           std::string_view words) {
    PROBE_TRY(check_batch_asked(options_, requests.size()));
    std::vector<Asked> all;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      auto asked = asked_of(requests[i], words);
      if (!asked) return of_item(asked.failure(), i, requests.size());
      all.push_back(std::move(*asked));
    }
    return policy_->answer_all(all, options_.chunk);
  }
  ServedPolicy& policy() { return *policy_; }

 private:
  static Result<Asked> asked_of(const wire::Value& request, std::string_view words) {
    PROBE_ASSIGN(wire::Array picture, first_picture(request));
    PROBE_ASSIGN(std::string text, text_at(request, words));
    return Asked{std::move(picture), std::move(text)};
  }

  ServeOptions options_;
  std::unique_ptr<ServedPolicy> policy_;
};

class IntactSpeaker final : public OpenpiSpeaker {
 public:
  using OpenpiSpeaker::OpenpiSpeaker;

 private:
  Result<wire::Frame> said(const wire::Value& request) override {
    if (request.find("new_model_path") != nullptr)
      return packed(wire::Map{{"status", "model switched"}});
    if (request.find("reset") != nullptr) {
      policy().reset();
      return packed(wire::Map{{"status", "reset"}});
    }
    PROBE_ASSIGN(const auto actions, act(request, "task"));
    return packed(actions_array(actions));
  }
};

class RoboArenaSpeaker final : public OpenpiSpeaker {
 public:
  using OpenpiSpeaker::OpenpiSpeaker;

 private:
  wire::Value metadata() const override {
    return wire::Map{{"image_resolution", wire::Value()}, {"needs_wrist_camera", false},
                     {"n_external_cameras", 1},           {"needs_stereo_camera", false},
                     {"needs_session_id", true},          {"action_space", "cartesian_velocity"}};
  }
  Result<wire::Frame> said(const wire::Value& request) override {
    PROBE_ASSIGN(const std::string endpoint, text_at(request, "endpoint"));
    if (endpoint == "reset") {
      policy().reset();
      return wire::text_frame("reset successful");
    }
    return OpenpiSpeaker::said(request);
  }
};

class StarVlaSpeaker final : public OpenpiSpeaker {
 public:
  using OpenpiSpeaker::OpenpiSpeaker;

 private:
  wire::Value metadata() const override {
    return wire::Map{{"env", "starvla_policy_server"},
                     {"available_unnorm_keys", wire::List{"oxe_bridge"}}};
  }
  // A question is the payload of a message, or the message itself.
  Result<wire::Frame> said(const wire::Value& message) override {
    const wire::Value* number = message.find("request_id");
    number_ = number == nullptr ? wire::Value("default") : *number;
    const wire::Value* payload = message.find("payload");
    const wire::Value& request = payload == nullptr ? message : *payload;
    const wire::Value* examples = request.find("examples");
    const auto* list = examples == nullptr ? nullptr : examples->as<wire::List>();
    if (list == nullptr || list->empty())
      return failed("expected `examples`, a list; got " + wire::describe(request));
    wire::List flat;
    for (const wire::Value& example : *list) {
      const wire::Value *images = example.find("image"), *words = example.find("lang");
      const auto* pictures = images == nullptr ? nullptr : images->as<wire::List>();
      if (pictures == nullptr || pictures->empty())
        return failed("expected `image`, a list; got " + wire::describe(example));
      flat.emplace_back(wire::Map{{"image", pictures->front()},
                                  {"lang", words == nullptr ? wire::Value() : *words}});
    }
    const auto all = act_all(flat, "lang");
    if (!all) return failed(all.failure().message);
    std::vector<policy::Action> actions;
    for (const auto& item : *all) actions.insert(actions.end(), item.begin(), item.end());
    wire::Array array = actions_array(actions);
    const auto items = static_cast<std::int64_t>(all->size());
    if (array.shape[0] % items != 0) return failed("answers of different lengths");
    array.shape = {items, array.shape[0] / items, 7};
    return packed(wire::Map{{"status", "ok"},
                            {"ok", true},
                            {"type", "inference_result"},
                            {"request_id", number_},
                            {"data", wire::Map{{"actions", std::move(array)}}}});
  }
  // Its connections outlive an error.
  wire::Frame failed(std::string message) const {
    return packed(wire::Map{{"status", "error"},
                            {"ok", false},
                            {"type", "inference_result"},
                            {"request_id", number_},
                            {"error", wire::Map{{"message", std::move(message)}}}});
  }

  wire::Value number_;  // of the question
};

template <typename Side>
Result<std::unique_ptr<wire::Listener>> listen_as(const ServeOptions& options) {
  return wire::listen_websocket(
      options.address, options.port, [options] { return std::make_unique<Side>(options); },
      options.tls);
}

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve_openpi(const ServeOptions& options) {
  return listen_as<OpenpiSpeaker>(options);
}
Result<std::unique_ptr<wire::Listener>> serve_intact(const ServeOptions& options) {
  return listen_as<IntactSpeaker>(options);
}
Result<std::unique_ptr<wire::Listener>> serve_roboarena(const ServeOptions& options) {
  return listen_as<RoboArenaSpeaker>(options);
}

Result<std::unique_ptr<wire::Listener>> serve_starvla(const ServeOptions& options) {
  return listen_as<StarVlaSpeaker>(options);
}

}  // namespace probe::servers
