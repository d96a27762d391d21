#include "runtime/libero/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "compiler/format/format.h"
#include "runtime/assets/mujoco.h"
#include "runtime/assets/mujoco_seen.h"
#include "runtime/assets/output_folder.h"
#include "runtime/base/file.h"
#include "runtime/compile/files.h"
#include "runtime/libero/probing_text.h"
#include "runtime/libero/released.h"
#include "runtime/libero/rooms.h"
#include "runtime/libero/suite_text.h"
#include "runtime/libero/words.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

using Path = fs::path;

bool is_folder(const Path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}
bool is_file(const Path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// Whether a path, which may not be there yet, lies in a folder; links are followed.
bool is_below(const Path& path, const Path& folder) {
  std::error_code error;
  const Path inner = fs::weakly_canonical(fs::absolute(path, error), error);
  const Path outer = fs::weakly_canonical(fs::absolute(folder, error), error);
  const auto [end, rest] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return end == outer.end();
}

// The first of some places that a lab's folder may have it at.
std::optional<Path> find_below(const std::string& from, std::initializer_list<const char*> places,
                               const char* wanted) {
  for (const char* const place : places) {
    const Path path = (Path(from) / place).lexically_normal();
    if (is_folder(path / wanted) || is_file(path / wanted)) return path;
  }
  return std::nullopt;
}

// Where a category's model is: below these folders of `assets`, in a folder of its own or beside
// others.
constexpr const char* kModelFolders[] = {"stable_scanned_objects", "stable_hope_objects",
                                         "turbosquid_objects", "articulated_objects"};
std::optional<Path> find_model(const Path& assets, const std::string& category) {
  for (const char* const folder : kModelFolders) {
    for (const Path& path : {assets / folder / category / (category + ".xml"),
                             assets / folder / (category + ".xml")}) {
      if (is_file(path)) return path;
    }
  }
  return std::nullopt;
}

// Files below robosuite's assets, and which of our meshes shows a body of theirs.
struct RobotFile {
  const char* file;
  std::map<std::string, std::string> links;
};
const RobotFile kRobotFiles[] = {
    {"robots/panda/robot.xml",
     {{"link0", "link0.glb"},
      {"link1", "link1.glb"},
      {"link2", "link2.glb"},
      {"link3", "link3.glb"},
      {"link4", "link4.glb"},
      {"link5", "link5.glb"},
      {"link6", "link6.glb"},
      {"link7", "link7.glb"}}},
    {"grippers/panda_gripper.xml",
     {{"right_gripper", "hand.glb"},
      {"leftfinger", "left_finger.glb"},
      {"rightfinger", "right_finger.glb"}}},
    {"mounts/rethink_mount.xml", {{"pedestal", "mount.glb"}, {"torso", "mount.glb"}}},
};

class LiberoImport {
 public:
  LiberoImport(const ImportOptions& options, assets::OutputFolder out)
      : options_(options), out_(std::move(out)) {}

  Result<ImportReport> run() {
    const auto root = find_below(options_.from, {"", "libero", "libero/libero"}, "bddl_files");
    if (!root)
      return Failure{Fault::kUsage, "no LIBERO folder: there is no `bddl_files`", options_.from};
    root_ = *root;
    for (const char* const place : {"assets", "libero_assets/libero"}) {
      if (assets_.empty() && is_folder(root_ / place)) assets_ = root_ / place;
    }
    if (assets_.empty())
      return Failure{Fault::kUsage, "there is no `assets` beside `bddl_files`", root_.string()};
    const std::string near =
        options_.robosuite.empty() ? (root_ / "libero_assets").string() : options_.robosuite;
    const auto robosuite = find_below(
        near, {"", "models/assets", "robosuite", "robosuite/models/assets", "assets"}, "base.xml");
    if (!robosuite) {
      return Failure{Fault::kUsage,
                     "no robosuite: there is no `models/assets/base.xml`; say where with "
                     "`--robosuite DIR`",
                     near};
    }
    base_ = (*robosuite / "base.xml").string();
    for (const Path& read : {root_ / "bddl_files", root_ / "init_files", assets_, *robosuite}) {
      if (!is_below(options_.to, read)) continue;
      return Failure{Fault::kUsage, "lies in `" + read.string() + "`, which is only read",
                     options_.to};
    }
    if (!options_.poses.empty()) PROBE_TRY(read_poses());
    for (const Suite& suite : suites()) PROBE_TRY(read_suite(suite));
    PROBE_TRY(check_poses());
    PROBE_TRY(convert_things());
    PROBE_TRY(convert_rooms());
    PROBE_TRY(write_things());
    PROBE_TRY(take_robots());
    for (auto& [suite, tasks] : tasks_) PROBE_TRY(write_one(*suite, tasks));
    PROBE_TRY(write_asked());
    if (report_.tasks == 0) {
      return Failure{Fault::kUsage, "no task can be read: " + cause(), options_.from};
    }
    for (const std::string& odd : odd_) say("odd", odd);
    for (const std::string& broken : broken_) say("broken", broken);
    report_.broken = broken_.size();
    if (poses_.empty()) {
      say("odd",
          "where fixtures stand is in no stored start: here in the middle of their regions, which "
          "are 2 cm wide; `--poses FILE` says it otherwise");
    }
    report_.bytes = out_.bytes();
    report_.suites = written_;
    PROBE_TRY(out_.finish());
    return std::move(report_);
  }

 private:
  void say(std::string word, std::string text) {
    report_.lines.push_back({std::move(word), std::move(text)});
  }
  // Why there is no task: a model that is lacking, a task that is left out, or what comes first.
  std::string cause() const {
    if (!lacking_.empty()) return lacking_.begin()->first + ": " + lacking_.begin()->second;
    for (const ImportLine& line : report_.lines) {
      if (line.text.find(" is left out: ") != line.text.npos) return line.text;
    }
    return report_.lines.front().text;
  }
  // Paths as they are below the folder that was given.
  std::string shorter(std::string text) const {
    const std::string prefix = (root_ / "").string();
    for (std::size_t at = text.find(prefix); at != text.npos; at = text.find(prefix))
      text.erase(at, prefix.size());
    return text;
  }

  Status write(const std::string& path, std::string_view bytes, const std::string& source) {
    PROBE_TRY(out_.write(path, bytes, source));
    ++report_.files;
    return {};
  }

  // ---- what is there

  Status read_suite(const Suite& suite) {
    const Path folder = root_ / "bddl_files" / suite.folder;
    std::vector<std::string> stems;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      if (at->path().extension() == ".bddl") stems.push_back(at->path().stem().string());
    }
    if (stems.empty()) {
      say("missing",
          fmt::format("{}: no task, there is no bddl_files/{}", suite.folder, suite.folder));
      return {};
    }
    const TaskOrder order = order_tasks(suite, stems);
    for (const std::string& stem : order.missing) {
      left_out_.insert({std::string(suite.folder), stem});
      say("missing", fmt::format("{}: {}.bddl", suite.folder, stem));
    }
    for (const std::string& stem : order.strange) {
      say("odd", fmt::format("{}: {}.bddl is no task of the released benchmark and is left out",
                             suite.folder, stem));
    }
    if (order.missing.empty() && order.stems.size() != suite.tasks) {
      say("odd", fmt::format("{} has {} tasks, the released one {}: another version", suite.folder,
                             order.stems.size(), suite.tasks));
    }
    std::vector<std::string> others;  // than the released ones
    std::vector<TaskSource>& tasks = tasks_.emplace_back(&suite, std::vector<TaskSource>()).second;
    for (std::size_t i = 0; i < order.stems.size(); ++i) {
      const std::string& stem = order.stems[i];
      const std::string path = (folder / (stem + ".bddl")).string();
      const auto text = read_file(
          path, {.most = std::size_t{1} << 20, .code = Fault::kUsage, .only_begin = false});
      if (!text) {
        leave_out(suite, stem, to_text(text.failure()));
        continue;
      }
      if (!is_released_problem(suite.folder, order.numbers[i], *text)) others.push_back(stem);
      BddlRead read = read_bddl(*text, path);
      for (const Failure& odd : read.oddities) odd_.insert(shorter(to_text(odd)));
      if (!read.mistakes.empty()) {
        for (const Failure& mistake : read.mistakes) leave_out(suite, stem, to_text(mistake));
        continue;
      }
      tasks.push_back({order.numbers[i], stem, std::move(read.problem), {}});
    }
    say_others(suite, "problems", others, order.stems.size());
    return {};
  }

  void say_others(const Suite& suite, const char* what, const std::vector<std::string>& stems,
                  std::size_t all) {
    if (stems.empty()) return;
    say("odd", fmt::format("{}: the {} of {} of {} tasks are not the released ones, so published "
                           "rates are not of them: {}{}",
                           suite.folder, what, stems.size(), all, stems.front(),
                           stems.size() > 1 ? ", .." : ""));
  }

  void leave_out(const Suite& suite, const std::string& stem, const std::string& why) {
    left_out_.insert({std::string(suite.folder), stem});
    say("missing", fmt::format("{}: {} is left out: {}", suite.folder, stem, shorter(why)));
  }

  // suite,task,fixture,x_m,y_m,z_m,qw,qx,qy,qz
  Status read_poses() {
    PROBE_ASSIGN(const std::string text, read_file(options_.poses));
    std::size_t line_number = 0;
    std::string_view rest = text;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      ++line_number;
      if (line.ends_with('\r')) line.remove_suffix(1);
      const std::string where = options_.poses + ":" + std::to_string(line_number);
      constexpr std::string_view kHeader = "suite,task,fixture,x_m,y_m,z_m,qw,qx,qy,qz";
      if (line_number == 1) {
        if (line != kHeader)
          return Failure{Fault::kUsage, "expected the header " + std::string(kHeader), where};
        continue;
      }
      if (line.empty()) continue;
      std::vector<std::string_view> cells;
      for (std::string_view left = line;; left.remove_prefix(left.find(',') + 1)) {
        cells.push_back(left.substr(0, left.find(',')));
        if (left.find(',') == left.npos) break;
      }
      if (cells.size() != 10)
        return Failure{Fault::kUsage, fmt::format("expected 10 cells, found {}", cells.size()),
                       where};
      FixturePose pose{
          std::string(cells[0]), std::string(cells[1]), std::string(cells[2]), {}, where};
      double squares = 0;
      for (std::size_t i = 0; i < 7; ++i) {
        double value = 0;
        const std::string_view cell = cells[3 + i];
        const auto [at, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc() || at != cell.data() + cell.size() || !std::isfinite(value))
          return Failure{Fault::kUsage, fmt::format("expected a number, found `{}`", cell), where};
        (i < 3 ? pose.pose.position[i] : pose.pose.rotation[i - 3]) = value;
        squares += i < 3 ? 0 : value * value;
      }
      if (std::abs(squares - 1) > 1e-5)
        return Failure{Fault::kUsage, "a quaternion has length 1", where};
      poses_.push_back(std::move(pose));
    }
    return {};
  }

  // After the suites are read: every row is of a fixture that is there, each once. Rows of tasks
  // that are left out, with a line of their own, stay.
  Status check_poses() const {
    std::map<std::tuple<std::string, std::string, std::string>, std::string> first;
    for (const FixturePose& pose : poses_) {
      const auto suite = std::ranges::find_if(
          tasks_, [&](const auto& one) { return one.first->folder == pose.suite; });
      if (suite == tasks_.end() && !is_suite(pose.suite))
        return Failure{Fault::kUsage, "there is no suite `" + pose.suite + "`", pose.where};
      const auto [known, is_new] =
          first.try_emplace({pose.suite, pose.stem, pose.fixture}, pose.where);
      if (!is_new)
        return Failure{Fault::kUsage,
                       "says once more where `" + pose.fixture + "` stands, as " + known->second,
                       pose.where};
      if (suite == tasks_.end() || left_out_.contains({pose.suite, pose.stem})) continue;
      const auto task = std::ranges::find(suite->second, pose.stem, &TaskSource::stem);
      if (task == suite->second.end())
        return Failure{Fault::kUsage, "`" + pose.suite + "` has no task `" + pose.stem + "`",
                       pose.where};
      if (std::ranges::find(task->problem.fixtures, pose.fixture, &BddlThing::name) ==
          task->problem.fixtures.end())
        return Failure{Fault::kUsage, "the task has no fixture `" + pose.fixture + "`", pose.where};
    }
    return {};
  }
  static bool is_suite(const std::string& name) {
    return std::ranges::any_of(suites(), [&](const Suite& suite) { return suite.folder == name; });
  }

  // ---- models

  // The fixture that everything is put on: its regions have rectangles.
  static bool is_workspace(const BddlProblem& problem, const BddlThing& thing) {
    return std::ranges::any_of(problem.regions, [&](const BddlRegion& region) {
      return region.target == thing.name && !region.ranges.empty();
    });
  }

  // Why a task's things cannot be called as it calls them: an import has one text of things.
  std::optional<std::string> clash_of(const TaskSource& task,
                                      const std::set<std::string>& categories) const {
    static constexpr std::string_view kTaken[] = {"source",        "target",      "helper",
                                                  "helper_target", "distractors", "surface"};
    for (const BddlThing& object : task.problem.objects) {
      const std::string name = "`" + object.name + "`";
      if (categories.contains(object.name)) return name + " is the name of a category, too";
      if (std::ranges::find(kTaken, object.name) != std::end(kTaken))
        return name + " is a word of the language";
      const auto known = instances_.find(object.name);
      if (known != instances_.end() && known->second != object.category) {
        return name + " is of category " + object.category + " here and of " + known->second +
               " in an earlier task";
      }
    }
    return std::nullopt;
  }

  void leave_out_clashes() {
    std::set<std::string> categories;
    for (const auto& [suite, tasks] : tasks_) {
      for (const TaskSource& task : tasks) {
        for (const auto* things : {&task.problem.objects, &task.problem.fixtures}) {
          for (const BddlThing& thing : *things) categories.insert(thing.category);
        }
      }
    }
    for (auto& [suite, tasks] : tasks_) {
      std::erase_if(tasks, [&, of = suite](const TaskSource& task) {
        const auto clash = clash_of(task, categories);
        if (clash) leave_out(*of, task.stem, *clash);
        if (clash) return true;
        for (const BddlThing& object : task.problem.objects)
          instances_[object.name] = object.category;
        return false;
      });
    }
  }

  Status convert_things() {
    leave_out_clashes();
    std::map<std::string, bool> wanted;  // category -> whether it stands
    for (const auto& [suite, tasks] : tasks_) {
      for (const TaskSource& task : tasks) {
        for (const BddlThing& object : task.problem.objects) {
          wanted.emplace(object.category, false);
        }
        for (const BddlThing& fixture : task.problem.fixtures) {
          if (!is_workspace(task.problem, fixture)) wanted[fixture.category] = true;
        }
      }
    }
    for (const auto& [category, stands] : wanted) {
      const auto model = find_model(assets_, category);
      if (!model) {
        lacking_[category] = "there is no " + category + ".xml";
        continue;
      }
      assets::MujocoOptions options;
      options.file = model->string();
      options.name = category;
      options.merged_into = base_;
      // robosuite's MujocoXMLObject gives what moves a free joint with this damping.
      if (!stands) options.free_damping = 0.0005;
      options.kind = stands ? assets::MujocoKind::kFixture : assets::MujocoKind::kObject;
      // The benchmark's FlatStove.turn_on: from there on its site `burner` is seen.
      if (category == "flat_stove") options.glows.push_back({"burner", "button", 0.5});
      const auto made = assets::convert_mujoco(options);
      if (!made) {
        lacking_[category] = shorter(to_text(made.failure()));
        continue;
      }
      for (const assets::MujocoFile& file : made->files)
        PROBE_TRY(write(file.path, file.bytes, shorter(file.source)));
      for (const std::string& note : made->notes) odd_.insert(shorter(note));
      declarations_[category] = made->declaration;
      Thing& thing = things_[category];
      thing.category = category;
      thing.is_fixture = stands;
      thing.low = made->low;
      thing.high = made->high;
      for (const assets::MujocoJoint& joint : made->joints)
        thing.joints.push_back({joint.name, joint.part});
      for (const assets::MujocoSite& site : made->sites) {
        if (site.name == "bottom_site") thing.bottom = site.pose.position.z();
        if (!site.region.empty()) thing.regions.push_back({site.region, site.part});
      }
      say(stands ? "fixture" : "object",
          fmt::format("{}: {:.4g} g, {}", category, made->mass * 1000, shorter(model->string())));
    }
    for (const auto& [category, why] : lacking_) say("missing", category + ": " + why);
    return {};
  }

  // The rooms of scenes that tasks play in; a scene whose room cannot be made has none.
  Status convert_rooms() {
    std::set<std::string_view> wanted;
    for (const auto& [suite, tasks] : tasks_) {
      for (const TaskSource& task : tasks) wanted.insert(scene_of_class(task.problem));
    }
    for (const Room& room : rooms()) {
      if (!wanted.contains(room.scene)) continue;
      const auto made = make_room(room, assets_.string(), base_);
      if (!made) {
        say("missing", fmt::format("{} has no room, black is behind its things: {}", room.scene,
                                   shorter(to_text(made.failure()))));
        continue;
      }
      for (const assets::MujocoFile& file : made->files)
        PROBE_TRY(write(file.path, file.bytes, shorter(file.source)));
      for (const std::string& note : made->notes) odd_.insert(shorter(note));
      rooms_.insert(std::string(room.scene));
      say("room",
          fmt::format("{}: {}", room.scene, shorter((assets_ / "scenes" / room.file).string())));
    }
    return {};
  }

  // The category of a task that is lacking.
  std::optional<std::string> lack_of(const TaskSource& task) const {
    for (const auto* things : {&task.problem.objects, &task.problem.fixtures}) {
      for (const BddlThing& thing : *things) {
        if (lacking_.contains(thing.category)) return thing.category;
      }
    }
    return std::nullopt;
  }

  // ---- texts

  Status write_one(const Suite& suite, std::vector<TaskSource>& tasks) {
    JointsOf joints_of;
    for (const auto& [category, thing] : things_) {
      for (const ThingJoint& joint : thing.joints) joints_of[category].push_back(joint.name);
    }
    std::vector<TaskSource> whole;
    std::vector<std::string> others;  // than the released ones
    std::size_t starts = 0;
    for (TaskSource& task : tasks) {
      if (const auto lacking = lack_of(task)) {
        leave_out(suite, task.stem, "it needs " + *lacking);
        continue;
      }
      const Path path = root_ / "init_files" / suite.folder / (task.stem + ".pruned_init");
      auto states = read_states(path.string(), task.problem, joints_of);
      if (!states) {
        leave_out(suite, task.stem, to_text(states.failure()));
        continue;
      }
      const auto bytes = read_file(path.string());
      if (bytes && !are_released_starts(suite.folder, task.number, *bytes))
        others.push_back(task.stem);
      for (std::size_t i = 0; i < states->starts.size(); ++i) {
        if (states->starts[i].time == 0 && states->starts[i].fastest == 0) continue;
        odd_.insert(
            fmt::format("{}: start {} of {} has a time or speeds other than 0, which are "
                        "not taken",
                        suite.folder, i, task.stem));
        break;
      }
      task.states = std::move(*states);
      starts += task.states.starts.size();
      whole.push_back(std::move(task));
    }
    if (whole.empty()) return {};
    say_others(suite, "stored starts", others, whole.size());
    PROBE_ASSIGN(const SuiteText text, write_suite(suite, whole, things_, rooms_, poses_, taken_));
    const std::string path = std::string(suite.folder) + ".probe";
    const std::string problems = "bddl_files/" + std::string(suite.folder);
    for (const SuiteText::Table& table : text.tables)
      PROBE_TRY(write(table.path, table.text, "init_files/" + std::string(suite.folder)));
    PROBE_TRY(write_text(path, text.text, problems));
    // What a check finds in a task's words and starts is the benchmark's own: it stays, and is said
    // above the task.
    PROBE_ASSIGN(const Reasons reasons, reasons_in(path));
    PROBE_TRY(write_text(path, with_reasons(text.text, reasons), problems));
    --report_.files;
    for (const std::string& note : text.notes) odd_.insert(note);
    written_.emplace_back(suite.folder);
    for (std::size_t i = 0; i < whole.size(); ++i)
      asked_.push_back({text.tasks[i], instruction_of(whole[i].stem), std::move(whole[i].problem)});
    say("suite", fmt::format("{}: {} tasks, {} starts", suite.folder, whole.size(), starts));
    report_.tasks += whole.size();
    report_.starts += starts;
    return {};
  }

  // All tasks together, asked what the benchmark does not ask.
  Status write_asked() {
    std::size_t all = 0;
    for (const Suite& suite : suites()) all += suite.tasks;
    if (asked_.size() != all) {
      say("missing",
          fmt::format("probing.probe, which asks all {} tasks: {} are there", all, asked_.size()));
      return {};
    }
    const SuiteText text = write_probing(written_, asked_, things_, rooms_);
    for (const SuiteText::Table& table : text.tables)
      PROBE_TRY(write(table.path, table.text, "init_files"));
    PROBE_TRY(write_allowed("probing.probe", text.text));
    return write_allowed("clean.probe", write_clean(written_, asked_));
  }

  // With an @allow above each declaration of which a check says something.
  Status write_allowed(const std::string& path, const std::string& text) {
    PROBE_TRY(write_text(path, text, "bddl_files"));
    // One thing is said once of many tasks: what is allowed of some may then be said of others.
    constexpr int kRounds = 4;
    Reasons reasons;
    for (int round = 0; round < kRounds; ++round) {
      PROBE_ASSIGN(const Reasons more, reasons_in(path));
      if (more.empty()) break;
      for (const auto& [declaration, said] : more) {
        for (const auto& [slug, why] : said) {
          std::string& reason = reasons[declaration][slug];
          reason += (reason.empty() ? "" : "; ") + why;
        }
      }
      PROBE_TRY(write_text(path, with_reasons(text, reasons), "bddl_files"));
      --report_.files;
    }
    return {};
  }

  static constexpr std::string_view kBegins[] = {"task ", "variants of ", "variant "};

  // By declaration, "task NAME", and word of @allow.
  using Reasons = std::map<std::string, std::map<std::string, std::string>>;

  // What a check says of the tasks of a text that was written.
  Result<Reasons> reasons_in(const std::string& path) {
    compile::FilesRequest request;
    request.assets = out_.path();
    request.wants_plan = false;
    PROBE_ASSIGN(const Compilation checked,
                 compile::compile_files({out_.path() + "/" + path}, request));
    Reasons reasons;
    for (const Diagnostic& said : checked.diagnostics.items()) {
      const CodeInfo& code = info(said.code);
      const bool is_here = !said.primary.is_none() &&
                           checked.sources.file(said.primary.file).name().ends_with("/" + path);
      const auto task = is_here ? task_around(checked.sources, said.primary) : std::nullopt;
      if (said.severity == Severity::kError) {
        broken_.insert(fmt::format("{}: {}: {}", task.value_or(path), code.text, said.message));
        continue;
      }
      if (code.slug.empty() || !task) {
        odd_.insert(fmt::format("{}: {}: {}", path, code.text, said.message));
        continue;
      }
      std::string& reason = reasons[*task][std::string(code.slug)];
      reason += (reason.empty() ? "" : "; ") + plain(said.message, *task);
    }
    return reasons;
  }

  // The task in whose declaration something stands, or whose variants: the last ones that begin
  // before it.
  static std::optional<std::string> task_around(const SourceSet& sources, const Span& span) {
    if (span.is_none()) return std::nullopt;
    const std::string_view text = sources.file(span.file).text();
    const std::string_view before = text.substr(0, span.begin);
    std::optional<std::string> found;
    std::size_t last = 0;
    for (const std::string_view begin : kBegins) {
      const std::size_t at = before.rfind(fmt::format("\n{}", begin));
      if (at == before.npos || at < last) continue;
      last = at;
      const std::size_t name = at + 1 + begin.size();
      found = std::string(begin) + std::string(text.substr(name, text.find(' ', name) - name));
    }
    return found;
  }

  // Without the marks that a text's string cannot hold, and without the task that it stands above.
  static std::string plain(std::string message, const std::string& declaration) {
    const std::string task = declaration.substr(declaration.rfind(' ') + 1);
    for (const std::string& tail : {" of `" + task + "`", " in `" + task + "`"}) {
      if (const std::size_t at = message.find(tail); at != message.npos)
        message.erase(at, tail.size());
    }
    std::erase_if(message, [](char c) { return c == '`'; });
    std::ranges::replace(message, '"', '\'');
    return message;
  }

  static std::string with_reasons(const std::string& text, const Reasons& reasons) {
    std::string out;
    std::size_t from = 0;
    while (from < text.size()) {
      const std::size_t end = std::min(text.find('\n', from), text.size() - 1) + 1;
      const std::string_view line = std::string_view(text).substr(from, end - from);
      for (const std::string_view begin : kBegins) {
        if (!line.starts_with(begin)) continue;
        const auto known = reasons.find(std::string(line.substr(0, line.find(' ', begin.size()))));
        if (known == reasons.end()) continue;
        for (const auto& [slug, why] : known->second)
          out += fmt::format("@allow({}, \"the benchmark's own: {}\")\n", slug, why);
      }
      out += line;
      from = end;
    }
    return out;
  }

  // As `fmt` lays it out.
  Status write_text(const std::string& path, std::string text, const std::string& source) {
    SourceSet sources;
    const FileId id = sources.add(path, std::move(text));
    Diagnostics diagnostics;
    PROBE_ASSIGN(const auto laid_out, format::format_file(sources, id, diagnostics));
    if (!laid_out) return Failure{Fault::kInternal, "a text that was written does not parse", path};
    return write(path, *laid_out, source);
  }

  Status write_things() {
    std::string text =
        "# The benchmark's things: how they look, weigh and feel is in their files, what their "
        "names "
        "prove is said with them; more facts and phrases are yours to say.\n"
        "use \"suite/libero/words.probe\"\n";
    if (!rooms_.empty()) text += "use \"suite/libero/stage.probe\"\n";
    const auto is_there = [&](std::string_view name) {
      const auto known = instances_.find(std::string(name));
      return known != instances_.end() && things_.contains(known->second);
    };
    for (const auto& [category, declaration] : declarations_)
      text += "\n" + described(category, declaration, is_there);
    if (!rooms_.empty()) text += "\n# ---- rooms ----\n";
    for (const std::string& scene : rooms_)
      text +=
          fmt::format("scene {} like {} {{ backdrop \"{}\" stands }}\n", with_room(scene), scene, scene);
    text += "\n# ---- as tasks call them ----\n";
    for (const auto& [name, category] : instances_) {
      if (things_.contains(category))
        text += fmt::format("object {} like {} {{}}\n", name, category);
    }
    PROBE_TRY(write_text("things.probe", std::move(text), "assets"));
    return {};
  }

  // The robots are ours, with the benchmark's meshes where its files are there.
  Status take_robots() {
    const Path robots = Path(options_.own) / "robots/panda";
    std::vector<Path> files;
    std::error_code error;
    for (fs::recursive_directory_iterator at(robots, error), end; !error && at != end;
         at.increment(error)) {
      if (at->is_regular_file()) files.push_back(at->path());
    }
    if (files.empty())
      return Failure{Fault::kAsset, "our own robots are not there", robots.string()};
    std::ranges::sort(files);
    check_robosuite();
    const std::map<std::string, std::string> seen = robot_meshes();
    for (const Path& file : files) {
      const std::string to = file.lexically_relative(options_.own).generic_string();
      if (const auto made = seen.find(file.filename().string()); made != seen.end()) {
        PROBE_TRY(write(to, made->second, "robosuite"));
        continue;
      }
      PROBE_ASSIGN(const std::string bytes, read_file(file.string()));
      PROBE_TRY(write(to, bytes, "vlaprobe's own"));
    }
    return {};
  }

  // How the arm moves and is felt is said by our own robot, which is held to one version.
  void check_robosuite() {
    std::string others;
    for (const std::string_view path : released_robosuite_files()) {
      const auto text = read_file((Path(base_).parent_path() / path).string());
      if (!text || is_released_robosuite(path, *text)) continue;
      others += (others.empty() ? "" : ", ") + std::string(path);
    }
    if (others.empty()) return;
    say("odd", "robosuite is not version 1.4.1 (" + others +
                   "): the arm is that version's whatever they say, and published rates may be of "
                   "another");
  }

  // What robosuite shows of the arm, the gripper and the mount, by the name of our file. Its bodies
  // and our links have the same frames.
  std::map<std::string, std::string> robot_meshes() {
    std::map<std::string, std::string> made;
    const Path robosuite = Path(base_).parent_path();
    for (const auto& [file, links] : kRobotFiles) {
      std::vector<std::string> notes;
      const auto seen = assets::seen_bodies((robosuite / file).string(), base_, links, notes);
      if (!seen) {
        say("missing", fmt::format("{}: vlaprobe's own meshes are shown instead: {}", file,
                                   to_text(seen.failure())));
        continue;
      }
      for (const std::string& note : notes) odd_.insert(note);
      made.insert(seen->begin(), seen->end());
      say("robot", file);
    }
    return made;
  }

  const ImportOptions& options_;
  assets::OutputFolder out_;
  ImportReport report_;
  Path root_, assets_;
  std::string base_;
  std::vector<FixturePose> poses_;
  std::set<std::pair<std::string, std::string>> left_out_;  // suite and task
  std::vector<std::pair<const Suite*, std::vector<TaskSource>>> tasks_;
  Things things_;
  std::map<std::string, std::string> declarations_, instances_, lacking_;
  std::set<std::string> rooms_;  // scenes that have theirs
  std::set<std::string> taken_;  // names of fixtures and scenes
  std::vector<std::string> written_;
  std::vector<AskedTask> asked_;
  std::set<std::string> odd_, broken_;
};

}  // namespace

Result<ImportReport> import_libero(const ImportOptions& options) {
  PROBE_ASSIGN(auto out, assets::OutputFolder::create(options.to));
  return LiberoImport(options, std::move(out)).run();
}

}  // namespace probe::libero
