#include "runtime/mcp/server.h"

#include <unistd.h>

#include <cerrno>

namespace probe::mcp {
namespace {

// Versions whose messages are these, the newest first.
constexpr std::string_view kVersions[] = {"2025-06-18", "2025-03-26", "2024-11-05"};
constexpr std::size_t kLongestMessage = std::size_t{4} << 20;

enum Code { kParse = -32700, kRequest = -32600, kMethod = -32601, kParameters = -32602 };

std::string error(const Json& id, Code code, const std::string& message) {
  const Json json = {{"jsonrpc", "2.0"},
                     {"id", id},
                     {"error", {{"code", static_cast<int>(code)}, {"message", message}}}};
  return json.dump();
}

std::string result(const Json& id, Json value) {
  const Json json = {{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(value)}};
  return json.dump();
}

Json hello(const Json& parameters) {
  const std::string wanted = parameters.value("protocolVersion", "");
  std::string_view version = kVersions[0];
  for (const std::string_view known : kVersions) {
    if (known == wanted) version = known;
  }
  Json json = {{"protocolVersion", version},
               {"serverInfo", {{"name", "vlaprobe"}, {"version", VLAPROBE_VERSION}}},
               {"instructions",
                "Probing tasks for vision-language-action policies. Write a .probe text, `check` it "
                "until it has no findings, `list`, `show`, `draw` and `preview` what it means, "
                "`run` a policy, then `results`, `why`, `compare` and `gate`. `explain` has an "
                "essay on every diagnostic."}};
  json["capabilities"]["tools"] = Json::object();
  return json;
}

bool write_line(int out, std::string line) {
  line += '\n';
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t put = ::write(out, line.data() + done, line.size() - done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    done += static_cast<std::size_t>(put);
  }
  return true;
}

}  // namespace

std::optional<std::string> answer(Tools& tools, std::string_view message) {
  const Json request = Json::parse(message);
  if (request.is_discarded()) return error(nullptr, kParse, "this line is no JSON");
  const Json* method = request.find("method");
  const Json* given_id = request.find("id");
  if (!request.is_object() || method == nullptr || !method->is_string()) {
    // An answer to a question of ours, of which there are none, or no message.
    if (request.contains("result") || request.contains("error")) return std::nullopt;
    return error(given_id == nullptr ? Json() : *given_id, kRequest,
                 "this is no request: an object with `method`");
  }
  if (given_id == nullptr) return std::nullopt;
  const Json id = *given_id;
  if (!id.is_string() && !id.is_number()) return error(nullptr, kRequest, "`id` is text or number");
  const Json* given = request.find("params");
  const Json parameters = given == nullptr ? Json::object() : *given;
  const std::string& name = method->text();
  if (name == "initialize") return result(id, hello(parameters));
  if (name == "ping") return result(id, Json::object());
  if (name == "tools/list") {
    Json all = Json::object();
    all["tools"] = tools.list();
    return result(id, std::move(all));
  }
  if (name == "tools/call") {
    const std::string tool = parameters.value("name", "");
    if (!tools.has(tool)) return error(id, kParameters, "there is no tool `" + tool + "`");
    const Json* arguments = parameters.find("arguments");
    return result(id, tools.call(tool, arguments == nullptr ? Json::object() : *arguments));
  }
  return error(id, kMethod, "there is no method `" + name + "`");
}

void serve(int in, int out, Tools& tools) {
  std::string line;
  bool is_skipped = false;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(in, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    for (const char c : std::string_view(buffer, static_cast<std::size_t>(got))) {
      if (c != '\n') {
        if (line.size() < kLongestMessage) {
          line += c;
        } else {
          is_skipped = true;
        }
        continue;
      }
      std::optional<std::string> said;
      if (is_skipped) {
        said = error(nullptr, kRequest, "a message has 4 MiB at most");
      } else if (line.find_first_not_of(" \t\r") != line.npos) {
        said = answer(tools, line);
      }
      line.clear();
      is_skipped = false;
      if (said && !write_line(out, std::move(*said))) return;
    }
  }
}

}  // namespace probe::mcp
