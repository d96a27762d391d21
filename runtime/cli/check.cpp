// vlaprobe check
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <utility>

#include "runtime/base/digit_groups.h"
#include "runtime/base/say.h"
#include "runtime/cli/compile.h"
#include "runtime/cli/watch.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/source_goal.h"

namespace probe::cli {
namespace {

struct CheckArguments {
  std::vector<std::string> files;
  bool json = false, watch = false;
  AssetOptions assets;
};

// What a change of may change the outcome. A file that a `use` did not find is in no list, so while
// there are mistakes the folders count as well.
std::vector<std::string> to_watch(const CheckArguments& arguments, const CompiledText& text) {
  std::vector<std::string> paths = arguments.files;
  paths.insert(paths.end(), text.files.begin(), text.files.end());
  if (text.exit == kFine) return paths;
  for (std::size_t i = 0, files = paths.size(); i < files; ++i) {
    const auto folder = std::filesystem::path(paths[i]).parent_path();
    paths.push_back(folder.empty() ? "." : folder.string());
  }
  return paths;
}

// "1 error", "1,224 starts".
std::string counted(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", digit_groups(count), thing, count == 1 ? "" : "s");
}

// How much was looked at, what was found, how long it took: a silent success looks like nothing.
void say_outcome(const CompiledText& text, double milliseconds) {
  const std::string found =
      text.errors + text.warnings == 0
          ? "no findings"
          : counted(text.errors, "error") + ", " + counted(text.warnings, "warning");
  say("{}, {} in {}: {}, {:.0f} ms\n", counted(text.tasks, "task"), counted(text.starts, "start"),
      counted(text.files.size(), "file"), found, milliseconds);
}

// Of more than so many starts it is not asked which tasks have skills.
constexpr std::size_t kMostStartsAsked = 20'000;
constexpr std::size_t kMostTasksNamed = 6;

// The tasks for whose goal policy `expert` finds no skills, one of those that are judged alike in
// one scene standing for all.
std::vector<std::string> without_skills(const plan::Plan& plan) {
  std::vector<std::string> names;
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> known;  // by program and scene
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) {
    const plan::TaskRecord& record = plan.tasks()[task];
    if (!plan::skills_of(plan.tables(), task).empty()) continue;
    const auto [at, is_new] = known.try_emplace({record.program, record.scene}, true);
    if (is_new) {
      const auto has = vm::has_skills(plan, task);
      at->second = !has.ok() || *has;
    }
    if (!at->second) names.emplace_back(plan.text(record.name));
  }
  return names;
}

// "`a`, `b` and 3 more".
std::string named(const std::vector<std::string>& tasks) {
  std::string list;
  for (std::size_t i = 0; i < tasks.size() && i < kMostTasksNamed; ++i)
    list += (i == 0 ? "`" : ", `") + tasks[i] + "`";
  if (tasks.size() > kMostTasksNamed)
    list += fmt::format(" and {} more", tasks.size() - kMostTasksNamed);
  return list;
}

void say_without_skills(const std::vector<std::string>& names, std::size_t tasks) {
  if (names.empty()) return;
  say("note: policy `expert` finds no skills for {} of {}: {}; `solution {{ .. }}` says how\n",
      digit_groups(names.size()), counted(tasks, "task"), named(names));
}

// One line for all tasks that keep the same number of the same number of starts.
void say_chosen(const std::vector<ChosenStarts>& chosen) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::string>> tasks;
  for (const ChosenStarts& task : chosen) {
    auto& names = tasks[{task.starts, task.of}];
    if (std::ranges::find(names, task.task) == names.end()) names.push_back(task.task);
  }
  for (const auto& [kept, names] : tasks) {
    say("note: `where clear` keeps {} of {} in {}\n", digit_groups(kept.first),
        counted(kept.second, "start"), named(names));
  }
}

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int watch_verb(const CheckArguments& arguments) {
  constexpr std::chrono::milliseconds kPoll(100);
  const Interrupt interrupt;
  FileWatch files;
  CompiledText last;
  bool first = true, edited = false;
  std::error_code ignored;
  while (true) {
    files.begin();
    const auto start = Clock::now();
    CompiledText text =
        compile_quietly(arguments.files, arguments.assets, "", false, arguments.json);
    const double milliseconds = milliseconds_since(start);
    files.watch(to_watch(arguments, text));
    // An editor's own files come and go in the folder; only news are printed.
    if (first || edited || text.said != last.said || text.exit != last.exit) {
      print_diagnostics(text, arguments.json);
      say_outcome(text, milliseconds);
    }
    if (first) say("watching; Ctrl-C ends\n");
    first = false;
    last = std::move(text);
    // A change, and then until the editor has finished.
    edited = false;
    bool waiting = true;
    while (true) {
      if (interrupt.wait(waiting ? kPoll : kPoll / 4)) return last.exit;
      const std::vector<std::string> changed = files.changed();
      if (changed.empty() && !waiting) break;
      waiting = waiting && changed.empty();
      for (const std::string& path : changed)
        edited = edited || !std::filesystem::is_directory(path, ignored);
    }
  }
}

int check_verb(const CheckArguments& arguments) {
  const auto start = Clock::now();
  std::vector<std::string> names;
  PlanTaker plans;
  plans.most_starts = kMostStartsAsked;
  if (!arguments.json) {
    plans.take = [&](std::vector<std::byte> bytes) {
      const auto plan = plan::Plan::from_bytes(std::move(bytes), {.identity = false});
      if (!plan.ok()) return;
      // Several programs may use one task.
      for (std::string& name : without_skills(*plan)) {
        if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
      }
    };
    plans.forget = [&] { names.clear(); };
  }
  const CompiledText text =
      compile_text(arguments.files, arguments.assets, "", false, arguments.json, false, plans);
  if (!text.files.empty()) say_outcome(text, milliseconds_since(start));
  if (text.exit == kFine && !arguments.json) say_chosen(text.chosen);
  if (text.exit == kFine) say_without_skills(names, text.tasks);
  return text.exit;
}

}  // namespace

void add_check(Verb app, int& exit) {
  auto arguments = std::make_shared<CheckArguments>();
  Verb verb = app.add_subcommand("check", "diagnose sources");
  verb.footer("example: vlaprobe check --watch suite/intact.probe");
  verb.add_option("F", arguments->files, ".probe texts").required();
  verb.add_flag("--watch", arguments->watch,
                "again whenever one of them, or what it uses, changes");
  verb.add_flag("--json", arguments->json, "diagnostics as a JSON array on stdout");
  verb.add_option("--tasks", arguments->assets.tasks,
                  "glob: only these tasks, where the assets lack what others need");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] {
    exit = arguments->watch ? watch_verb(*arguments) : check_verb(*arguments);
  });
}

}  // namespace probe::cli
