// Lifecycle, texts, diagnostics; what is asked of texts is in answers.
#include "runtime/lsp/server.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <set>

#include "runtime/base/asset_root.h"
#include "runtime/base/json.h"
#include "runtime/compile/library.h"
#include "runtime/lsp/answers.h"
#include "runtime/lsp/background.h"
#include "runtime/lsp/uri.h"
#include "runtime/lsp/values.h"
#include "runtime/lsp/workspace.h"

namespace probe::lsp {
namespace {

// Of JSON-RPC and of the protocol.
enum ErrorCode : int {
  kParseError = -32700,
  kInvalidRequest = -32600,
  kMethodNotFound = -32601,
  kInvalidParams = -32602,
  kNotInitialized = -32002,
  kRequestFailed = -32803,
};

class TextServer final : public Server {
 public:
  TextServer(ServerOptions options, language::Setting setting, Send send)
      : options_(std::move(options)),
        send_(std::move(send)),
        workspace_(std::move(setting)),
        background_(options_.pause) {}

  void receive(std::string_view message) override {
    const std::lock_guard lock(mutex_);
    const Json json = Json::parse(message);
    if (json.is_discarded()) return fail(Json(), kParseError, "a message that is no JSON");
    if (json.is_array()) return fail(Json(), kInvalidRequest, "messages come one by one");
    const Json* id = json.find("id");
    const Json* method = json.find("method");
    if (method == nullptr || !method->is_string()) {
      // An answer to what was asked of the editor: nothing waits for it.
      const bool is_answer = json.contains("result") || json.contains("error");
      if (!is_answer)
        fail(id == nullptr ? Json() : *id, kInvalidRequest, "expected a `method`");
      return;
    }
    const Json* params = json.find("params");
    static const Json kNone = Json::object();
    const Json& given = params != nullptr && params->is_object() ? *params : kNone;
    if (id == nullptr) return notice(method->text(), given);
    if (!id->is_string() && !id->is_number() && !id->is_null())
      return fail(Json(), kInvalidRequest, "an `id` is a number or a text");
    request(*id, method->text(), given);
  }

  void receive_mistake(std::string_view what) override {
    const std::lock_guard lock(mutex_);
    fail(Json(), kParseError, std::string(what));
  }

  void settle() override {
    const std::lock_guard lock(mutex_);
    update();
  }

  bool has_ended() const override { return has_ended_; }
  int exit_code() const override { return was_shut_down_ ? 0 : 1; }

  bool wait_checked(std::chrono::milliseconds limit) override {
    std::unique_lock lock(mutex_);
    update();
    return checked_.wait_for(lock, limit, [&] { return open_checks_ == 0; });
  }

 private:
  // ---- messages out
  void say(Json message) {
    message["jsonrpc"] = "2.0";
    send_(message.dump());
  }
  void fail(const Json& id, int code, const std::string& message) {
    say({{"id", id}, {"error", {{"code", code}, {"message", message}}}});
  }
  void ask_client(const char* method, Json params = Json()) {
    Json message = {{"id", "vlaprobe-" + std::to_string(++asked_)}, {"method", method}};
    if (!params.is_null()) message["params"] = std::move(params);
    say(std::move(message));
  }

  // ---- requests
  void request(const Json& id, const std::string& method, const Json& params) {
    if (method == "initialize") {
      if (is_initialized_) return fail(id, kInvalidRequest, "`initialize` was asked already");
      initialize(params);
      return say({{"id", id},
                  {"result",
                   {{"capabilities", capabilities()},
                    {"serverInfo", {{"name", "vlaprobe"}, {"version", VLAPROBE_VERSION}}}}}});
    }
    if (!is_initialized_) return fail(id, kNotInitialized, "`initialize` comes first");
    if (was_shut_down_) return fail(id, kInvalidRequest, "nothing is asked after `shutdown`");
    if (method == "shutdown") {
      was_shut_down_ = true;
      background_.cancel();
      return say({{"id", id}, {"result", Json()}});
    }
    const Answer answer = find_answer(method);
    if (answer == nullptr) return fail(id, kMethodNotFound, "there is no `" + method + "`");
    // Not every editor tells of what changes on the disk, and an edit of old lines is a wrong one.
    if (method == "textDocument/rename") touch("");
    const Result<Json> result = answer(workspace_, client_, params);
    if (!result) {
      const bool is_ours = result.failure().code != Fault::kUsage;
      return fail(id, is_ours ? kRequestFailed : kInvalidParams, to_text(result.failure()));
    }
    say({{"id", id}, {"result", *result}});
  }

  void initialize(const Json& params) {
    is_initialized_ = true;
    const Json* folders = params.find("workspaceFolders");
    if (folders != nullptr && folders->is_array()) {
      for (const Json& folder : *folders) add_folder(read_text(folder, {"uri"}));
    } else {
      add_folder(read_text(params, {"rootUri"}));
    }
    const Json* given = params.find("capabilities");
    if (given == nullptr) return;
    client_.has_related =
        read_flag(*given, {"textDocument", "publishDiagnostics", "relatedInformation"});
    client_.pulls = find(*given, {"textDocument", "diagnostic"}) != nullptr;
    client_.refreshes = read_flag(*given, {"workspace", "diagnostics", "refreshSupport"});
    client_.refreshes_hints = read_flag(*given, {"workspace", "inlayHint", "refreshSupport"});
    client_.refreshes_lenses = read_flag(*given, {"workspace", "codeLens", "refreshSupport"});
    client_.refreshes_tokens =
        read_flag(*given, {"workspace", "semanticTokens", "refreshSupport"});
    client_.watches =
        read_flag(*given, {"workspace", "didChangeWatchedFiles", "dynamicRegistration"});
    client_.has_hierarchy = read_flag(
        *given, {"textDocument", "documentSymbol", "hierarchicalDocumentSymbolSupport"});
  }

  void add_folder(const std::string& uri) {
    const std::string path = path_of(uri);
    if (path.starts_with('/')) workspace_.folders.push_back(path);
  }

  // ---- notices
  void notice(const std::string& method, const Json& params) {
    if (method == "exit") {
      has_ended_ = true;
      return;
    }
    if (!is_initialized_ || was_shut_down_) return;
    const std::string path = path_of(read_text(params, {"textDocument", "uri"}));
    if (method == "initialized") {
      if (client_.watches) {
        const Json watcher = {{"globPattern", "**/*.{probe,csv,urdf}"}};
        const Json options = {{"watchers", Json::array({watcher})}};
        const Json registration = {{"id", "texts"},
                                   {"method", "workspace/didChangeWatchedFiles"},
                                   {"registerOptions", options}};
        ask_client("client/registerCapability",
                   {{"registrations", Json::array({registration})}});
      }
    } else if (method == "textDocument/didOpen") {
      if (path.empty()) return;
      Document document{read_text(params, {"textDocument", "uri"}), version_of(params),
                        read_text(params, {"textDocument", "text"})};
      workspace_.documents.open(path, std::move(document));
      touch(path);
    } else if (method == "textDocument/didChange") {
      if (workspace_.documents.change(path, version_of(params), changes_of(params))) touch(path);
    } else if (method == "textDocument/didClose") {
      if (workspace_.documents.close(path)) touch(path);
    } else if (method == "workspace/didChangeWatchedFiles") {
      const Json* changes = find(params, {"changes"});
      if (changes == nullptr || changes->size() == 0) return touch("");
      for (const Json& change : *changes) {
        // A table is of the programs that read it; a text that is new may be what one lacks.
        const std::string changed = path_of(read_text(change, {"uri"}));
        touch(changed.ends_with(".csv") ? changed : "");
      }
    } else if (method == "workspace/didChangeWorkspaceFolders") {
      const Json* removed = find(params, {"event", "removed"});
      const Json* added = find(params, {"event", "added"});
      if (removed != nullptr) {
        for (const Json& folder : *removed)
          std::erase(workspace_.folders, path_of(read_text(folder, {"uri"})));
      }
      if (added != nullptr) {
        for (const Json& folder : *added) add_folder(read_text(folder, {"uri"}));
      }
      touch("");
    }
  }

  static std::int64_t version_of(const Json& params) {
    const Json* version = find(params, {"textDocument", "version"});
    return version != nullptr && version->is_number() ? version->get<std::int64_t>() : 0;
  }

  static std::vector<Change> changes_of(const Json& params) {
    std::vector<Change> changes;
    const Json* given = params.find("contentChanges");
    if (given == nullptr) return changes;
    for (const Json& one : *given) {
      if (!one.is_object() || one.find("text") == nullptr) continue;
      changes.push_back({read_range(one.find("range")), read_text(one, {"text"})});
    }
    return changes;
  }

  void touch(const std::string& path) {
    workspace_.touch(path);
    is_stale_ = true;
    ++generation_;
    background_.cancel();
    open_checks_ = 0;
  }

  // ---- diagnostics
  void update() {
    if (!is_stale_) return;
    is_stale_ = false;
    workspace_.refresh();
    publish();
    if (auto old = workspace_.take_old()) background_.let_go(std::move(old));
    ask_whole_checks();
  }

  void publish() {
    if (client_.pulls) return;
    std::map<std::string, Json> by_uri;
    std::map<std::string, std::set<std::string>> known;
    const auto uri_for = [&](const std::string& path) {
      const Document* document = workspace_.documents.find(path);
      return document != nullptr ? document->uri : uri_of(path);
    };
    for (const auto& [path, document] : workspace_.documents.all())
      by_uri[document.uri] = Json::array();
    for (const auto& program : workspace_.programs()) {
      for (const syntax::ParseResult& file : program->now->files()) {
        const std::string& path = program->now->path(file.file.id);
        // A text of two programs has what both say, each once.
        for (const Diagnostic* said : program->said(file.file.id)) {
          Json& items = by_uri[uri_for(path)];
          if (items.is_null()) items = Json::array();
          Json item = to_json(*program->now, *said, client_.has_related);
          if (known[path].insert(item.dump()).second) items.push_back(std::move(item));
        }
      }
    }
    for (const auto& [uri, shown] : shown_) {
      if (!by_uri.contains(uri)) by_uri[uri] = Json::array();
    }
    for (auto& [uri, items] : by_uri) {
      const Document* document = workspace_.documents.find(path_of(uri));
      std::string text = items.dump();
      const bool is_empty = items.empty();
      const auto at = shown_.find(uri);
      // An open text is told of at each version, so that an editor knows that it was looked at.
      const bool is_news = at == shown_.end() ? document != nullptr || !is_empty
                                              : at->second.first != text ||
                                                    (document != nullptr &&
                                                     at->second.second != document->version);
      if (is_news) {
        Json params = {{"uri", uri}, {"diagnostics", std::move(items)}};
        if (document != nullptr) params["version"] = document->version;
        say({{"method", "textDocument/publishDiagnostics"}, {"params", std::move(params)}});
      }
      if (is_empty && document == nullptr) {
        shown_.erase(uri);
      } else {
        shown_[uri] = {std::move(text), document == nullptr ? 0 : document->version};
      }
    }
  }

  void ask_whole_checks() {
    std::vector<std::string> roots;
    for (const auto& program : workspace_.programs()) {
      if (!program->is_checked) roots.push_back(program->root);
    }
    open_checks_ = roots.size();
    if (roots.empty()) {
      checked_.notify_all();
      return;
    }
    background_.ask([this, roots = std::move(roots), unsaved = workspace_.documents.texts(),
                     generation = generation_](const std::atomic<bool>& stop) {
      for (const std::string& root : roots) {
        const auto checked =
            check_whole(root, unsaved, options_.assets, options_.library, stop);
        const std::lock_guard lock(mutex_);
        if (stop || generation != generation_) return;
        if (checked) take(root, *checked);
        if (--open_checks_ == 0) checked_.notify_all();
      }
    });
  }

  void take(const std::string& root, const WholeCheck& checked) {
    for (const auto& program : workspace_.programs()) {
      if (program->root == root) Workspace::take(*program, checked);
    }
    publish();
    if (client_.pulls && client_.refreshes) ask_client("workspace/diagnostic/refresh");
  }

  const ServerOptions options_;
  const Send send_;
  mutable std::mutex mutex_;  // of all below
  std::condition_variable checked_;
  Workspace workspace_;
  Client client_;
  bool is_initialized_ = false, was_shut_down_ = false, is_stale_ = false;
  std::atomic<bool> has_ended_ = false;
  std::uint64_t generation_ = 0, asked_ = 0;
  std::size_t open_checks_ = 0;
  // What was published: the list as text, and of which version.
  std::map<std::string, std::pair<std::string, std::int64_t>> shown_;
  Background background_;  // the last: it ends before what it works on
};

}  // namespace

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options, Send send) {
  PROBE_ASSIGN(AssetRoot root, find_asset_root(options.assets));
  PROBE_ASSIGN(std::vector<std::string> library, compile::find_library_folders(options.library));
  return std::unique_ptr<Server>(std::make_unique<TextServer>(
      options, language::Setting{std::move(root), std::move(library)}, std::move(send)));
}

}  // namespace probe::lsp
