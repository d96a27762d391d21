#include "runtime/studio/text_ear.h"

#include "runtime/base/json.h"
#include "runtime/lsp/uri.h"
#include "runtime/lsp/values.h"

namespace probe::studio {
namespace {

class TextEar final : public wire::Ear {
 public:
  TextEar(const Folder& folder, std::shared_ptr<wire::Mouth> mouth)
      : folder_(folder), mouth_(std::move(mouth)) {}

  Status begin(const lsp::ServerOptions& options) {
    PROBE_ASSIGN(server_, lsp::Server::start(options, [mouth = mouth_](const std::string& said) {
                   mouth->say(wire::text_frame(said));
                 }));
    return {};
  }

  void hear(const wire::Frame& frame) override {
    const std::string text(frame.bytes.begin(), frame.bytes.end());
    // By some messages the server would go to other folders; what is no message is for it to say.
    Json message = Json::parse(text);
    const std::string method = message.is_object() ? message.value("method", "") : "";
    if (method == "workspace/didChangeWorkspaceFolders") return;
    if (method == "textDocument/didOpen") {
      const std::string path =
          lsp::path_of(lsp::read_text(message, {"params", "textDocument", "uri"}));
      if (!folder_.has(path)) return refuse(path);
    }
    if (method == "initialize") {
      Json* params = message.find("params");
      if (params != nullptr && params->is_object()) {
        const std::string uri = lsp::uri_of(folder_.root());
        (*params)["rootUri"] = uri;
        (*params)["workspaceFolders"] = Json::array({{{"uri", uri}, {"name", folder_.root()}}});
        return server_->receive(message.dump());
      }
    }
    server_->receive(text);
  }

  void rest() override {
    server_->settle();
    if (server_->has_ended()) mouth_->end("the editor said `exit`");
  }

 private:
  void refuse(const std::string& path) {
    const Json params = {{"type", 1},
                         {"message", path + " is no text of the folder " + folder_.root()}};
    const Json message = {{"jsonrpc", "2.0"}, {"method", "window/showMessage"}, {"params", params}};
    mouth_->say(wire::text_frame(message.dump()));
  }

  const Folder& folder_;
  const std::shared_ptr<wire::Mouth> mouth_;
  std::unique_ptr<lsp::Server> server_;
};

}  // namespace

Result<std::unique_ptr<wire::Ear>> make_text_ear(const Folder& folder,
                                                 const lsp::ServerOptions& options,
                                                 std::shared_ptr<wire::Mouth> mouth) {
  auto ear = std::make_unique<TextEar>(folder, std::move(mouth));
  PROBE_TRY(ear->begin(options));
  return std::unique_ptr<wire::Ear>(std::move(ear));
}

}  // namespace probe::studio
