// GR00T's protocol from the server's side, see gr00t.cpp. The form is the question's: nested maps,
// an observation among options, or an observation alone (N1.5).
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/wire/msgpack.h"

namespace probe::servers {
namespace {

constexpr const char* kServedNames[] = {"x", "y", "z", "roll", "pitch", "yaw", "gripper"};
constexpr std::string_view kServedWords = "annotation.human.action.task_description";

class Gr00tSpeaker final : public wire::Speaker {
 public:
  explicit Gr00tSpeaker(const ServeOptions& options)
      : chunk_(options.chunk), policy_(options.policy()) {}

  Reply answer(const wire::Frame& asked) override {
    auto value = [&]() -> Result<wire::Value> {
      PROBE_ASSIGN(const wire::Value request, wire::from_msgpack(asked.bytes));
      return said(request);
    }();
    if (!value) value = wire::Value(wire::Map{{"error", value.failure().message}});
    return {{wire::Frame{false, wire::to_msgpack(*value, wire::ArrayStyle::kNpy)}}};
  }

 private:
  Result<wire::Value> said(const wire::Value& request) {
    PROBE_ASSIGN(const std::string endpoint, text_at(request, "endpoint"));
    if (endpoint == "ping")
      return wire::Value(wire::Map{{"status", "ok"}, {"message", "Server is running"}});
    if (endpoint == "reset") {
      policy_->reset();
      return wire::Value(wire::Map{});
    }
    const wire::Value* data = request.find("data");
    if (endpoint != "get_action" || data == nullptr) return bad("Unknown endpoint: " + endpoint);
    const wire::Value* options = data->find("observation");
    const wire::Value& seen = options == nullptr ? *data : *options;
    const wire::Value *video = seen.find("video"), *language = seen.find("language");
    const bool is_nested = video != nullptr && language != nullptr;
    PROBE_ASSIGN(wire::Array picture, first_picture(is_nested ? *video : seen));
    PROBE_ASSIGN(std::string words, text_at(is_nested ? *language : seen, kServedWords));
    PROBE_ASSIGN(const auto actions,
                 policy_->answer({std::move(picture), std::move(words)}, chunk_));
    wire::Map columns;
    for (std::size_t i = 0; i < std::size(kServedNames); ++i) {
      std::vector<double> column;
      for (const policy::Action& action : actions) column.push_back(action[i]);
      const auto count = static_cast<std::int64_t>(column.size());
      const std::vector<std::int64_t> shape = options == nullptr
                                                  ? std::vector<std::int64_t>{count, 1}
                                                  : std::vector<std::int64_t>{1, count, 1};
      columns.emplace_back((is_nested ? "" : "action.") + std::string(kServedNames[i]),
                           wire::array_f64(shape, column));
    }
    if (options == nullptr) return wire::Value(std::move(columns));
    return wire::Value(wire::List{std::move(columns), wire::Map{}});
  }

  int chunk_;
  std::unique_ptr<ServedPolicy> policy_;
};

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve_gr00t(const ServeOptions& options) {
  return wire::listen_zmq(options.address, options.port,
                          [options] { return std::make_unique<Gr00tSpeaker>(options); });
}

}  // namespace probe::servers
