// OpenVLA's REST protocol from the server's side, see openvla.cpp.
#include "runtime/servers/protocols/served_sides.h"
#include "runtime/wire/json.h"

namespace probe::servers {
namespace {

class OpenVlaSpeaker final : public wire::Speaker {
 public:
  explicit OpenVlaSpeaker(const ServeOptions& options)
      : chunk_(options.chunk), policy_(options.policy()) {}

  Reply answer(const wire::Frame& asked) override {
    auto body = said(
        std::string_view(reinterpret_cast<const char*>(asked.bytes.data()), asked.bytes.size()));
    if (!body) return {{wire::text_frame(body.failure().message)}, "failed"};
    return {{wire::text_frame(*body)}};
  }

 private:
  Result<std::string> said(std::string_view body) {
    PROBE_ASSIGN(wire::Value request, wire::from_json(body));
    const wire::Value* encoded = request.find("encoded");
    const bool is_encoded = encoded != nullptr && encoded->as<std::string>() != nullptr;
    if (is_encoded) {
      PROBE_ASSIGN(wire::Value inner, wire::from_json(*encoded->as<std::string>()));
      request = std::move(inner);
    }
    PROBE_ASSIGN(wire::Array picture, first_picture(request));
    PROBE_ASSIGN(std::string words, text_at(request, "instruction"));
    PROBE_ASSIGN(const auto actions,
                 policy_->answer({std::move(picture), std::move(words)}, chunk_));
    wire::Array array = actions_array(actions);
    if (actions.size() == 1) array.shape.erase(array.shape.begin());
    std::string plain = wire::to_json(array);
    return is_encoded ? wire::to_json(wire::Value(std::move(plain))) : plain;
  }

  int chunk_;
  std::unique_ptr<ServedPolicy> policy_;
};

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve_openvla(const ServeOptions& options) {
  return wire::listen_http(
      options.address, options.port,
      [options] { return std::make_unique<OpenVlaSpeaker>(options); }, options.tls);
}

}  // namespace probe::servers
