// How soon a language server tells of mistakes: types what a session says, a key at a time, and
// takes the time from each key to the diagnostics of the text that it made. Wall and processor time
// of the thread that answers, as one says little on a machine that others use.
//
//   typing SESSION.. [--pause MS] [--pace MS] [--slowest N]
//
// --pause: how long nothing is typed until the whole check begins (250; it never does, as keys
// follow each other at once). With --pause 0 --pace 5 it is under way at every key and has to be
// given up. --slowest lists what took longest. A session is a file of lines:
//
//   open PATH           a text of this repository, beside those that are open; what follows is about it
//   go "TEXT"           behind the first place that has it
//   type "TEXT"         a key a character; \n, \" and \\ as usual
//   erase N             so many keys back
//   complete, hover     asked at the cursor
#include <time.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tests/runtime/lsp/client.h"

namespace probe {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::vector<std::string> sessions;
  int pause = 250, pace = 0;
  std::size_t slowest = 0;
};

[[noreturn]] void die(const std::string& message) {
  fmt::print(stderr, "typing: {}\n", message);
  std::exit(2);
}

// Of this thread, in ms.
double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Took {
  double wall = 0, cpu = 0;  // ms
  std::string what;
};

// The least value that so many of all do not exceed.
double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

class Typist {
 public:
  explicit Typist(const Options& options)
      : options_(options),
        editor_(VLAPROBE_SOURCE_DIR "/suite", std::chrono::milliseconds(options.pause)) {}

  void play(const std::string& path) {
    std::ifstream in(path);
    if (!in) die("cannot read " + path);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (line.empty() || line.front() == '#') continue;
      where_ = path + ":" + std::to_string(number);
      const std::size_t space = line.find(' ');
      act(line.substr(0, space), space == line.npos ? "" : line.substr(space + 1));
    }
  }

  const std::map<std::string, std::vector<Took>>& took() const { return took_; }

 private:
  struct Text {
    std::string text;
    std::size_t cursor = 0;
    std::int64_t version = 1;
  };

  void act(const std::string& verb, const std::string& rest) {
    if (verb == "open") return open(rest);
    if (path_.empty()) die(where_ + ": expected `open` first");
    Text& now = texts_[path_];
    if (verb == "go") {
      const std::string text = unquoted(rest);
      const std::size_t at = now.text.find(text);
      if (at == now.text.npos) die(where_ + ": the text has no " + rest);
      now.cursor = at + text.size();
    } else if (verb == "type") {
      for (const char key : unquoted(rest)) edit(now, 0, std::string(1, key));
    } else if (verb == "erase") {
      const auto count = static_cast<std::size_t>(std::atoi(rest.c_str()));
      if (count == 0 || count > now.cursor) die(where_ + ": expected how many keys");
      for (std::size_t i = 0; i < count; ++i) edit(now, 1, "");
    } else if (verb == "complete") {
      ask(now, "completion");
    } else if (verb == "hover") {
      ask(now, "hover");
    } else {
      die(where_ + ": no verb `" + verb + "`");
    }
  }

  std::string unquoted(const std::string& text) const {
    if (text.size() < 2 || text.front() != '"' || text.back() != '"')
      die(where_ + ": expected a text in quotes");
    std::string out;
    for (std::size_t i = 1; i + 1 < text.size(); ++i) {
      if (text[i] == '\\') ++i;
      out += text[i] == 'n' && text[i - 1] == '\\' ? '\n' : text[i];
    }
    return out;
  }

  void open(const std::string& name) {
    path_ = std::string(VLAPROBE_SOURCE_DIR) + "/" + name;
    if (texts_.contains(path_)) return;
    Text& now = texts_[path_];
    now.text = test::text_of_file(path_);
    if (now.text.empty()) die(where_ + ": cannot read " + path_);
    take("opening", name, [&] { editor_.open(path_, now.text); });
  }

  static Json position(const Text& now, std::size_t at) {
    const auto begin = static_cast<std::ptrdiff_t>(now.text.rfind('\n', at - 1) + 1);
    const auto lines = std::count(now.text.begin(), now.text.begin() + begin, '\n');
    return {{"line", lines},
            {"character", static_cast<std::ptrdiff_t>(at) - (at == 0 ? 0 : begin)}};
  }

  // So many characters before the cursor become another text.
  void edit(Text& now, std::size_t back, const std::string& text) {
    const Json end = position(now, now.cursor), begin = position(now, now.cursor - back);
    const Json change = {{"range", {{"start", begin}, {"end", end}}}, {"text", text}};
    const Json message = {
        {"jsonrpc", "2.0"},
        {"method", "textDocument/didChange"},
        {"params",
         {{"textDocument", {{"uri", lsp::uri_of(path_)}, {"version", ++now.version}}},
          {"contentChanges", Json::array({change})}}}};
    const std::string bytes = message.dump();
    now.text.replace(now.cursor - back, back, text);
    now.cursor += text.size() - back;
    const std::string what =
        where_ + (back > 0 ? " erased to `" : " typed to `") +
        now.text.substr(now.cursor - std::min<std::size_t>(now.cursor, 12),
                        std::min<std::size_t>(now.cursor, 12)) + "`";
    take("diagnostics", what, [&] { editor_.raw(bytes); });
    if (editor_.published(path_) != now.version)
      die(where_ + ": the server said nothing of what was typed");
    if (options_.pace > 0) std::this_thread::sleep_for(std::chrono::milliseconds(options_.pace));
  }

  void ask(const Text& now, const std::string& what) {
    Json answer;
    take(what, where_, [&] {
      answer = editor_.ask("textDocument/" + what,
                           test::Editor::at(path_, position(now, now.cursor)));
    });
    if (answer.contains("error")) die(where_ + ": " + answer.dump());
    const bool has = what == "hover" ? answer.contains("contents")
                                     : answer.contains("items") && answer["items"].size() > 0;
    if (!has) die(where_ + ": nothing to tell there, behind: " + now.text.substr(now.cursor - std::min<std::size_t>(now.cursor, 60), std::min<std::size_t>(now.cursor, 60)));
  }

  template <typename Act>
  void take(const std::string& kind, const std::string& what, const Act& act) {
    editor_.forget();
    const auto begin = Clock::now();
    const double cpu = cpu_ms();
    act();
    editor_.server().settle();
    const double more = cpu_ms() - cpu;
    const double wall = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    took_[kind].push_back({wall, more, what});
  }

  const Options& options_;
  test::Editor editor_;
  std::string path_, where_;
  std::map<std::string, Text> texts_;
  std::map<std::string, std::vector<Took>> took_;
};

void print(const std::string& session, const std::map<std::string, std::vector<Took>>& took,
           std::size_t slowest) {
  for (const auto& [kind, all] : took) {
    std::vector<double> wall, cpu;
    for (const Took& one : all) wall.push_back(one.wall), cpu.push_back(one.cpu);
    fmt::print("{:<8} {:<12} {:>6} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f}\n", session, kind,
               all.size(), quantile(wall, 0.5), quantile(wall, 0.99), quantile(cpu, 0.5),
               quantile(cpu, 0.99), quantile(cpu, 1));
  }
  const auto typed = took.find("diagnostics");
  if (typed == took.end()) return;
  std::vector<Took> order = typed->second;
  std::ranges::sort(order, [](const Took& a, const Took& b) { return a.cpu > b.cpu; });
  for (std::size_t i = 0; i < std::min(slowest, order.size()); ++i)
    fmt::print("  {:.2f} ms wall, {:.2f} ms CPU: {}\n", order[i].wall, order[i].cpu, order[i].what);
}

int run(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto number = [&](const char* name) {
      if (++i == arguments.size()) die(std::string(name) + " takes a number");
      return std::atoi(arguments[i].c_str());
    };
    if (arguments[i] == "--pause") options.pause = number("--pause");
    else if (arguments[i] == "--pace") options.pace = number("--pace");
    else if (arguments[i] == "--slowest") options.slowest = static_cast<std::size_t>(number("--slowest"));
    else options.sessions.push_back(arguments[i]);
  }
  if (options.sessions.empty()) {
    for (const char* name : {"intact", "beyond"})
      options.sessions.push_back(std::string(VLAPROBE_SOURCE_DIR "/tests/bench/typing/") + name +
                                 ".session");
  }
  fmt::print("ms                             wall                 CPU\n");
  fmt::print("session  what          times    median       p99    median       p99      most\n");
  for (const std::string& session : options.sessions) {
    Typist typist(options);
    typist.play(session);
    print(std::filesystem::path(session).stem().string(), typist.took(), options.slowest);
  }
  return 0;
}

}  // namespace
}  // namespace probe

int main(int argc, char** argv) { return probe::run({argv + 1, argv + argc}); }
