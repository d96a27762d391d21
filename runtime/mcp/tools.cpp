#include "runtime/mcp/tools.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <thread>
#include <vector>

#include "runtime/base/clock.h"
#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/cluster/program.h"
#include "runtime/follow/follow.h"
#include "runtime/wire/base64.h"

namespace probe::mcp {
namespace {

// What agents are shown of one text, or of one structured answer; the rest is counted.
constexpr std::size_t kLongest = 60'000;

enum class Kind { kText, kTexts, kWhole };

struct Argument {
  const char* name;
  Kind kind;
  bool required;
  const char* about;
};

// How the words of a call become a verb's.
struct Given {
  const Json& arguments;

  std::string text(std::string_view name) const {
    const Json* value = arguments.find(name);
    if (value == nullptr) return "";
    return value->is_string() ? value->text() : std::to_string(value->get<std::int64_t>());
  }
  bool has(std::string_view name) const { return arguments.contains(name); }
};
using Words = std::vector<std::string>;

struct Tool {
  const char* name;
  const char* about;
  std::vector<Argument> arguments;
  // Of the structured answer: what the verb's JSON is called in it, and its type.
  const char* key;
  const char* type;
  bool writes = false;
  bool is_whole = false;  // of a text: a part of it is none
};

constexpr const char kFile[] = "a .probe text or .plan file";
constexpr const char kDir[] = "a results folder, as `run` writes it";

const std::vector<Tool>& all_tools() {
  static const std::vector<Tool> tools = {
      {"check",
       "Diagnose probing tasks (.probe texts): mistakes with place, reason and fix. Call it after "
       "every change of a text.",
       {{"files", Kind::kTexts, true, ".probe texts"}},
       "diagnostics",
       "array"},
      {"explain",
       "What a diagnostic such as P0402 means, with examples and how to mend it.",
       {{"code", Kind::kText, true, "P0402, or the word of an @allow"}},
       "explanation",
       "string"},
      {"list",
       "The tasks of a suite: instruction, baseline, what moved against it, how many starts.",
       {{"file", Kind::kText, true, kFile}},
       "tasks",
       "array"},
      {"show",
       "One task whole: objects, horizon, metrics, every start with the places of things.",
       {{"file", Kind::kText, true, kFile}, {"task", Kind::kText, true, "task name"}},
       "task",
       "object"},
      {"draw",
       "A task's starts from above, as SVG.",
       {{"file", Kind::kText, true, kFile}, {"task", Kind::kText, true, "task name"}},
       "svg",
       "string",
       false,
       true},
      {"preview",
       "What the policy sees first in a task: a picture of one start, or of all beside each other.",
       {{"file", Kind::kText, true, kFile},
        {"task", Kind::kText, true, "task name"},
        {"start", Kind::kWhole, false, "one start, from 0"}},
       "picture",
       "string"},
      {"run",
       "Evaluate a policy into a folder. Answers after wait_s seconds at most with what is there; "
       "the run goes on, and the same call again says how far it is, or continues what was ended.",
       {{"file", Kind::kText, true, kFile},
        {"policy", Kind::kText, true,
         "expert, null, random, reach, wrong, noisy:0.01, or a server: openpi://HOST:PORT?profile=P"},
        {"out", Kind::kText, true, "results folder to write or to continue"},
        {"tasks", Kind::kText, false, "glob over task names"},
        {"episodes", Kind::kText, false, "A-B: first and last start of each task"},
        {"seeds", Kind::kText, false, "A,B,... instead of the suite's"},
        {"jobs", Kind::kWhole, false, "worlds side by side"},
        {"wait_s", Kind::kWhole, false, "seconds until it answers (20, at most 50)"}},
       "run",
       "object",
       true},
      {"results",
       "What a run has found so far: counts, rates with intervals, newest failures.",
       {{"dir", Kind::kText, true, kDir}},
       "results",
       "object"},
      {"why",
       "Why an episode was judged so: each condition by source line with what was measured.",
       {{"dir", Kind::kText, true, kDir},
        {"task", Kind::kText, true, "task name"},
        {"episode", Kind::kWhole, true, "start, from 0"},
        {"seed", Kind::kWhole, false, "the lowest stored, unless given"}},
       "why",
       "object"},
      {"compare",
       "Two runs on the same starts: which differences are real, how large, in words and numbers.",
       {{"a", Kind::kText, true, kDir}, {"b", Kind::kText, true, kDir}},
       "comparison",
       "object"},
      {"gate",
       "May the new run's policy take the place of the old one's: worse, not worse or undecided.",
       {{"new", Kind::kText, true, kDir},
        {"against", Kind::kText, true, kDir},
        {"allow", Kind::kText, false, "how many more episodes may fail: 2%"}},
       "gate",
       "object"},
  };
  return tools;
}

const Tool* find_tool(std::string_view name) {
  const auto& tools = all_tools();
  const auto at = std::ranges::find_if(tools, [&](const Tool& tool) { return tool.name == name; });
  return at == tools.end() ? nullptr : &*at;
}

Json input_schema(const Tool& tool) {
  Json properties = Json::object(), required = Json::array();
  for (const Argument& argument : tool.arguments) {
    Json one = {{"description", argument.about}};
    if (argument.kind == Kind::kTexts) {
      one["type"] = "array";
      // A text that begins with a dash would be an option.
      one["items"] = {{"type", "string"}, {"pattern", "^[^-]"}};
      one["minItems"] = 1;
    } else if (argument.kind == Kind::kWhole) {
      one["type"] = "integer";
      one["minimum"] = 0;
    } else {
      one["type"] = "string";
      one["pattern"] = "^[^-]";
    }
    properties[argument.name] = std::move(one);
    if (argument.required) required.push_back(argument.name);
  }
  return {{"type", "object"},
          {"properties", std::move(properties)},
          {"required", std::move(required)},
          {"additionalProperties", false}};
}

Json output_schema(const Tool& tool) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}};
  schema["properties"][tool.key] = {{"type", tool.type}};
  schema["required"] = Json::array({tool.key});
  return schema;
}

bool fits(const Json& value, Kind kind) {
  const auto is_text = [](const Json& text) {
    return text.is_string() && !text.text().empty() && text.text()[0] != '-' &&
           text.text().find('\0') == std::string::npos;
  };
  if (kind == Kind::kWhole)
    return value.is_number_integer() && value.get<double>() >= 0 && value.get<double>() < 2e9;
  if (kind == Kind::kText) return is_text(value);
  return value.is_array() && !value.empty() && std::ranges::all_of(value, is_text);
}

// What is wrong with the arguments; empty: nothing.
std::string mistake(const Tool& tool, const Json& arguments) {
  if (!arguments.is_object()) return "arguments are an object";
  for (const auto& [name, value] : arguments.items()) {
    const auto at = std::ranges::find_if(
        tool.arguments, [&](const Argument& argument) { return argument.name == name; });
    if (at == tool.arguments.end())
      return fmt::format("`{}` has no argument `{}`", tool.name, name);
    if (!fits(value, at->kind)) {
      return fmt::format("`{}` of `{}` is {}", name, tool.name,
                         at->kind == Kind::kWhole  ? "a whole number from 0"
                         : at->kind == Kind::kText ? "a text that does not begin with a dash"
                                                   : "a list of texts that do not begin with a dash");
    }
  }
  for (const Argument& argument : tool.arguments) {
    if (argument.required && !arguments.contains(argument.name))
      return fmt::format("`{}` lacks `{}`: {}", tool.name, argument.name, argument.about);
  }
  return "";
}

std::string shortened(std::string text) {
  if (text.size() <= kLongest) return text;
  const std::size_t left = text.size() - kLongest;
  std::size_t end = kLongest;
  while (end > 0 && (text[end] & 0xC0) == 0x80) --end;  // not within a letter
  return text.substr(0, end) + fmt::format("\n... and {} bytes more", left);
}

Json text_content(std::string text) {
  return {{"type", "text"}, {"text", shortened(std::move(text))}};
}

Json error_result(std::string text) {
  Json result = {{"isError", true}};
  result["content"].push_back(text_content(std::move(text)));
  return result;
}

// As much of a list as an agent is shown; how many are left out. Never a part of an object, and of
// a text only what can be read without the rest.
std::size_t shorten_list(Json& list) {
  Json kept = Json::array();
  std::size_t bytes = 0;
  for (const Json& one : list) {
    bytes += one.dump().size() + 1;
    if (bytes > kLongest) break;
    kept.push_back(one);
  }
  const std::size_t left = list.size() - kept.size();
  if (left > 0) list = std::move(kept);
  return left;
}

Json good_result(const Tool& tool, Json value, std::string words = "") {
  const bool is_text = value.is_string();
  if (is_text && !tool.is_whole) {
    value = shortened(value.text());
  } else if (value.is_array()) {
    const std::size_t left = shorten_list(value);
    if (left > 0) {
      words = fmt::format("{} more are left out: the verb `{}` of vlaprobe has all\n", left,
                          tool.name) +
              words;
    }
  } else if (const std::size_t bytes = is_text ? value.text().size() : value.dump().size();
             bytes > kLongest) {
    return error_result(fmt::format("the answer has {} bytes, and {} at most are told here: ask for "
                                    "less, or call the verb `{}` of vlaprobe and read its output "
                                    "from a file",
                                    bytes, kLongest, tool.name));
  }
  Json result = {{"isError", false}};
  std::string text = is_text ? value.text() : value.dump(1);
  if (!words.empty()) text = words + (text.empty() ? "" : "\n" + text);
  result["content"].push_back(text_content(std::move(text)));
  result["structuredContent"][tool.key] = std::move(value);
  return result;
}

// A run that goes on while its call has been answered.
struct Child {
  pid_t process = -1;
  int log = -1;  // what it says: a file without a name, so that none is left
  std::vector<std::string> words;
};

class ProgramTools final : public Tools {
 public:
  explicit ProgramTools(std::string program) : program_(std::move(program)) {}
  ~ProgramTools() override {
    for (auto& [out, child] : runs_) {
      if (child.process > 0) {
        ::kill(-child.process, SIGTERM);
        ::waitpid(child.process, nullptr, 0);
      }
      if (child.log >= 0) ::close(child.log);
    }
  }

  Json list() const override {
    Json tools = Json::array();
    for (const Tool& tool : all_tools()) {
      tools.push_back({{"name", tool.name},
                       {"description", tool.about},
                       {"inputSchema", input_schema(tool)},
                       {"outputSchema", output_schema(tool)},
                       {"annotations", {{"readOnlyHint", !tool.writes}, {"openWorldHint", tool.writes}}}});
    }
    return tools;
  }

  bool has(std::string_view name) const override { return find_tool(name) != nullptr; }

  Json call(std::string_view name, const Json& arguments) override {
    const Tool& tool = *find_tool(name);
    if (const std::string wrong = mistake(tool, arguments); !wrong.empty())
      return error_result(wrong);
    const Given given{arguments};
    if (name == "run") return run(tool, given);
    if (name == "results") return results(tool, given.text("dir"));
    if (name == "preview") return preview(tool, given);
    if (name == "check") {
      Words words = {"check", "--json"};
      for (const Json& file : arguments["files"]) words.push_back(file.text());
      return from_json(tool, words, true);
    }
    if (name == "gate") {
      Words words = {"gate", given.text("new"), "--against", given.text("against"), "--json"};
      if (given.has("allow")) words.insert(words.end(), {"--allow", given.text("allow")});
      return from_json(tool, words, true);
    }
    Words words = {std::string(name)};
    for (const Argument& argument : tool.arguments) {
      if (given.has(argument.name)) words.push_back(given.text(argument.name));
    }
    if (name == "explain" || name == "draw") return from_text(tool, words);
    words.push_back("--json");
    return from_json(tool, words, false);
  }

 private:
  Result<cluster::ProgramOutput> asked(Words words) const {
    words.insert(words.begin(), program_);
    return cluster::run_program(words);
  }

  // `one_is_fine`: exit 1 says that something was found, which the JSON tells.
  Json from_json(const Tool& tool, const Words& words, bool one_is_fine) const {
    const auto output = asked(words);
    if (!output) return error_result(to_text(output.failure()));
    Json value = Json::parse(output->out);
    const bool is_fine = output->status == 0 || (one_is_fine && output->status == 1);
    if (!is_fine || value.is_discarded()) return error_result(output->err + output->out);
    return good_result(tool, std::move(value), output->err);
  }

  Json from_text(const Tool& tool, const Words& words) const {
    const auto output = asked(words);
    if (!output) return error_result(to_text(output.failure()));
    if (output->status != 0) return error_result(output->err + output->out);
    return good_result(tool, Json(output->out));
  }

  Json preview(const Tool& tool, const Given& given) const {
    char path[] = "/tmp/vlaprobe-preview-XXXXXX.png";
    const int file = ::mkstemps(path, 4);
    if (file < 0) return error_result("no file can be made in /tmp");
    ::close(file);
    Words words = {"preview", given.text("file"), given.text("task"), "-o", path};
    if (given.has("start")) words.insert(words.end(), {"--start", given.text("start")});
    const auto output = asked(words);
    const auto picture = read_file(path);
    std::remove(path);
    if (!output) return error_result(to_text(output.failure()));
    if (output->status != 0 || !picture) return error_result(output->err + output->out);
    const std::vector<std::uint8_t> bytes(picture->begin(), picture->end());
    Json result = {{"isError", false}};
    result["content"].push_back(
        {{"type", "image"}, {"data", wire::to_base64(bytes)}, {"mimeType", "image/png"}});
    result["structuredContent"][tool.key] = fmt::format("image/png, {} bytes", bytes.size());
    return result;
  }

  static Json seen(const std::string& dir) {
    follow::Following following(dir);
    const auto found = following.look(0);
    if (!found) return {{"trouble", to_text(found.failure())}};
    Json json = follow::to_json(*found);
    for (const char* paced : {"per_minute", "left_s"}) json.erase(paced);  // of one look: unknown
    return json;
  }

  static Json results(const Tool& tool, const std::string& dir) {
    if (!is_there(dir + "/results.sqlite") && !is_there(dir + "/shards"))
      return error_result(dir + ": no run here: results.sqlite is absent");
    Json json = seen(dir);
    if (const Json* trouble = json.find("trouble")) return error_result(trouble->text());
    return good_result(tool, std::move(json));
  }

  Json run(const Tool& tool, const Given& given) {
    const std::string out = absolute_path(given.text("out"));
    Words words = {"run", given.text("file"), "--policy", given.text("policy"), "-o", out};
    for (const char* flag : {"tasks", "episodes", "seeds", "jobs"}) {
      if (given.has(flag)) words.insert(words.end(), {std::string("--") + flag, given.text(flag)});
    }
    Child& child = runs_[out];
    if (child.process > 0 && child.words != words && ::waitpid(child.process, nullptr, WNOHANG) == 0)
      return error_result(out + ": another call writes this folder; wait for it or take another");
    if (child.process <= 0 || child.words != words) {
      if (!begin(child, words)) return error_result("the run cannot be started");
    }
    const auto begun = std::chrono::steady_clock::now();
    const double wait = given.has("wait_s") ? std::min(50.0, std::stod(given.text("wait_s"))) : 20;
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(child.process, &status, WNOHANG)) == 0 &&
           seconds_since(begun) < wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::string said = said_by(child);
    Json answer = is_there(out + "/results.sqlite") ? seen(out) : Json::object();
    answer["is_running"] = ended == 0;
    if (ended != 0) {
      child.process = -1;
      const int exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      answer["exit"] = exit;
      if (exit != 0 && exit != 2) return error_result(said);
      if (exit == 2 && !is_there(out + "/results.sqlite")) return error_result(said);
    }
    return good_result(tool, std::move(answer), said);
  }

  static std::string said_by(const Child& child) {
    // Of much the end, where the reason of a failure stands.
    constexpr std::size_t kMost = kLongest - 100;
    struct stat log {};
    const std::size_t size =
        ::fstat(child.log, &log) == 0 ? static_cast<std::size_t>(log.st_size) : 0;
    std::size_t before = size > kMost ? size - kMost : 0;
    std::string said(size - before, '\0');
    const ssize_t got = ::pread(child.log, said.data(), said.size(), static_cast<off_t>(before));
    said.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    if (before == 0) return said;
    // From the begin of a letter on.
    while (!said.empty() && (static_cast<unsigned char>(said.front()) & 0xC0) == 0x80) {
      said.erase(said.begin());
      ++before;
    }
    return "... " + std::to_string(before) + " bytes before\n" + said;
  }

  bool begin(Child& child, const Words& words) const {
    if (child.log < 0) {
      char path[] = "/tmp/vlaprobe-run-XXXXXX";
      child.log = ::mkostemp(path, O_CLOEXEC | O_APPEND);
      if (child.log < 0) return false;
      ::unlink(path);
    }
    if (::ftruncate(child.log, 0) != 0) return false;
    child.words = words;
    std::vector<char*> arguments = {const_cast<char*>(program_.c_str())};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    const pid_t parent = ::getpid();
    // This process has one thread, which the child's end hangs on: however an agent ends it, with a
    // signal or by SIGKILL, the run ends, too, and can be continued. posix_spawn cannot ask for that.
    child.process = ::fork();
    if (child.process == 0) {
      ::setpgid(0, 0);  // so that all of it can be ended
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      if (::getppid() != parent) ::_exit(127);
      ::dup2(nothing, STDIN_FILENO);
      ::dup2(child.log, STDOUT_FILENO);
      ::dup2(child.log, STDERR_FILENO);
      ::execvp(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(nothing);
    if (child.process > 0) ::setpgid(child.process, child.process);
    return child.process > 0;
  }

  const std::string program_;
  std::map<std::string, Child> runs_;  // by folder
};

}  // namespace

std::unique_ptr<Tools> Tools::make(std::string program) {
  return std::make_unique<ProgramTools>(std::move(program));
}

}  // namespace probe::mcp
