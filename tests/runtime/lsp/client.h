// An editor in a few lines: speaks to a Server in this process.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/lsp/server.h"
#include "runtime/lsp/uri.h"

namespace probe::test {

inline std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// The place of the first `needle`, and so many bytes behind it; texts before it are ASCII.
inline Json place_of(const std::string& text, const std::string& needle, std::size_t more = 0) {
  std::size_t at = text.find(needle);
  at = at == text.npos ? text.size() : at + more;
  std::size_t line = 0, begin = 0;
  for (std::size_t i = 0; i < at; ++i) {
    if (text[i] == '\n') ++line, begin = i + 1;
  }
  return {{"line", line}, {"character", at - begin}};
}

class Editor {
 public:
  explicit Editor(const std::string& folder, std::chrono::milliseconds pause = {},
                  Json capabilities = Json::object(), const AssetRoot& assets = {}) {
    auto server = lsp::Server::start({.assets = assets, .library = "", .pause = pause},
                                     [this](std::string message) {
                                       const std::lock_guard lock(mutex_);
                                       messages_.push_back(Json::parse(message));
                                     });
    server_ = std::move(server).value();
    if (folder.empty()) return;
    const Json root = lsp::uri_of(folder);
    initialized = ask("initialize", {{"processId", Json()},
                                     {"rootUri", root},
                                     {"capabilities", std::move(capabilities)}});
    tell("initialized", Json::object());
  }

  Json initialized;

  void raw(const std::string& message) {
    sent_.push_back(message);
    server_->receive(message);
  }
  // All that it said, in its order.
  const std::vector<std::string>& sent() const { return sent_; }
  void tell(const std::string& method, Json params) {
    Json message = {{"jsonrpc", "2.0"}, {"method", method}};
    message["params"] = std::move(params);
    raw(message.dump());
  }
  // The `result`, or an object that has `error`.
  Json ask(const std::string& method, Json params) {
    Json message = {{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}};
    message["params"] = std::move(params);
    raw(message.dump());
    const std::lock_guard lock(mutex_);
    for (const Json& answer : messages_) {
      const Json* id = answer.find("id");
      if (id == nullptr || !(*id == Json(id_)) || answer.contains("method")) continue;
      return answer.contains("error") ? Json{{"error", answer["error"]}} : answer["result"];
    }
    return "no answer";
  }

  void open(const std::string& path, const std::string& text) {
    tell("textDocument/didOpen", {{"textDocument",
                                   {{"uri", lsp::uri_of(path)},
                                    {"languageId", "probe"},
                                    {"version", 1},
                                    {"text", text}}}});
  }
  // All of it.
  void change(const std::string& path, const std::string& text) {
    tell("textDocument/didChange",
         {{"textDocument", {{"uri", lsp::uri_of(path)}, {"version", ++version_}}},
          {"contentChanges", Json::array({Json{{"text", text}}})}});
  }
  void change(const std::string& path, const Json& begin, const Json& end,
              const std::string& text) {
    const Json range = {{"start", begin}, {"end", end}};
    tell("textDocument/didChange",
         {{"textDocument", {{"uri", lsp::uri_of(path)}, {"version", ++version_}}},
          {"contentChanges", Json::array({Json{{"range", range}, {"text", text}}})}});
  }
  static Json document(const std::string& path) {
    return {{"textDocument", {{"uri", lsp::uri_of(path)}}}};
  }
  static Json at(const std::string& path, const Json& position) {
    Json params = document(path);
    params["position"] = position;
    return params;
  }

  lsp::Server& server() { return *server_; }
  // What was published of a text last: "P0402 P0205", with the whole check when asked for.
  std::string codes(const std::string& path, bool whole = false) {
    if (whole) {
      server_->wait_checked(std::chrono::seconds(60));
    } else {
      server_->settle();
    }
    const std::lock_guard lock(mutex_);
    std::string codes = "nothing was published";
    for (const Json& message : messages_) {
      if (message.value("method", "") != "textDocument/publishDiagnostics") continue;
      if (message["params"].value("uri", "") != lsp::uri_of(path)) continue;
      codes.clear();
      for (const Json& item : message["params"]["diagnostics"])
        codes += (codes.empty() ? "" : " ") + item["code"].text();
    }
    return codes;
  }
  // The version of which diagnostics were published last; -1 of none.
  std::int64_t published(const std::string& path) const {
    const std::lock_guard lock(mutex_);
    std::int64_t version = -1;
    for (const Json& message : messages_) {
      if (message.value("method", "") != "textDocument/publishDiagnostics") continue;
      const Json& params = message["params"];
      if (params.value("uri", "") == lsp::uri_of(path) && params.contains("version"))
        version = params["version"].get<std::int64_t>();
    }
    return version;
  }
  // Of what was said until now nothing is looked at again.
  void forget() {
    const std::lock_guard lock(mutex_);
    messages_.clear();
    sent_.clear();
  }
  std::vector<Json> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Json> messages_;
  std::vector<std::string> sent_;
  std::unique_ptr<lsp::Server> server_;
  std::int64_t id_ = 0, version_ = 1;
};

// A folder that is removed with it.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "vlaprobe-lsp-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path() const { return path_; }
  std::string write(const std::string& name, const std::string& text) const {
    const auto path = std::filesystem::path(path_) / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

 private:
  std::string path_;
};

}  // namespace probe::test
