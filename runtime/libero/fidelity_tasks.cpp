// What needs no simulation: words, horizons, order, goals and starts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "runtime/base/file.h"
#include "runtime/libero/bddl.h"
#include "runtime/libero/fidelity.h"
#include "runtime/libero/states.h"
#include "runtime/libero/suites.h"
#include "runtime/plan/fixtures.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

// A task of the original's folder.
struct OriginalTask {
  const Suite* suite = nullptr;
  std::size_t index = 0;
  std::string stem;
  BddlProblem problem;
  std::string name() const { return RecordedTask{"", stem, 0, {}}.name(); }
  std::string key() const { return fmt::format("{}_{:02}", suite->folder, index); }
};

Result<fs::path> root_of(const std::string& original) {
  for (const char* const below : {"", "libero", "libero/libero"}) {
    const fs::path root = (fs::path(original) / below).lexically_normal();
    std::error_code error;
    if (fs::is_directory(root / "bddl_files", error)) return root;
  }
  return Failure{Fault::kUsage, "no LIBERO folder: there is no `bddl_files`", original};
}

// Calls for each task of each suite that the folder has.
Status each_task(const fs::path& root, const std::function<Status(OriginalTask)>& visit) {
  for (const Suite& suite : suites()) {
    const fs::path folder = root / "bddl_files" / suite.folder;
    std::vector<std::string> stems;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      if (at->path().extension() == ".bddl") stems.push_back(at->path().stem().string());
    }
    const TaskOrder order = order_tasks(suite, stems);
    for (std::size_t i = 0; i < order.stems.size(); ++i) {
      const std::string path = (folder / (order.stems[i] + ".bddl")).string();
      PROBE_ASSIGN(const std::string text, read_file(path));
      BddlRead read = read_bddl(text, path);
      if (!read.mistakes.empty()) return read.mistakes.front();
      PROBE_TRY(visit({&suite, order.numbers[i], order.stems[i], std::move(read.problem)}));
    }
  }
  return {};
}

Json facts_json(const std::vector<BddlFact>& facts) {
  Json all = Json::array();
  for (const BddlFact& fact : facts) {
    Json one = Json::array();
    one.push_back(fact.predicate);
    for (const std::string& argument : fact.arguments) one.push_back(argument);
    all.push_back(std::move(one));
  }
  return all;
}

// What of a task differs; nothing: it is the same.
Result<std::string> difference(Imported& imported, const OriginalTask& task,
                               const Records* records) {
  PROBE_ASSIGN(const bool is_there, imported.has(task.suite->folder, task.name()));
  if (!is_there) return std::string("is not in the import");
  PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite->folder));
  const auto index = plan->find_task(task.name());
  const plan::TaskRecord& record = plan->tasks()[*index];
  if (plan->suites().empty()) return std::string("is of no suite");
  const auto members = plan->members(plan->suites()[0]);
  const auto at = std::ranges::find(members, *index);
  std::size_t number = static_cast<std::size_t>(at - members.begin());
  if (members.size() == task.suite->tasks && number != task.index)
    return fmt::format("is task {} of its suite, not {}", number, task.index);
  if (plan->text(record.prompt) != instruction_of(task.stem))
    return fmt::format("says \"{}\"", plan->text(record.prompt));
  if (record.horizon != task.suite->horizon || record.idle != kWaiting)
    return fmt::format("waits {} steps and ends after {}", record.idle, record.horizon);
  if (records == nullptr) return std::string();
  for (const RecordedTask& said : records->tasks()) {
    if (said.key() != task.key()) continue;
    if (said.stem != task.stem) return "is " + said.stem + " in the records";
    if (said.said["language"].text() != plan->text(record.prompt))
      return std::string("other words");
    if (said.said["horizon"].get<std::size_t>() != record.horizon)
      return std::string("other horizon");
    if (said.said["goal"].dump() != facts_json(task.problem.goal).dump())
      return std::string("other goal");
    return std::string();
  }
  return std::string("is not in the records");
}

}  // namespace

Result<FidelityRow> tasks_row(Imported& imported, const std::string& original,
                              const Records* records) {
  FidelityRow row{"instructions, horizons, goals, order",
                  "all",
                  "",
                  records == nullptr ? "plans against the folder's problems"
                                     : "plans and problems against the recorded table of tasks",
                  Held::kNo,
                  {}};
  PROBE_ASSIGN(const fs::path root, root_of(original));
  std::size_t all = 0;
  PROBE_TRY(each_task(root, [&](const OriginalTask& task) -> Status {
    ++all;
    PROBE_ASSIGN(const std::string differs, difference(imported, task, records));
    if (!differs.empty()) row.others.push_back(task.key() + ": " + differs);
    return {};
  }));
  if (all == 0) {
    row.how = "the folder has no task";
    row.held = Held::kNotMeasured;
    return row;
  }
  row.figure = fmt::format("{} of {}", all - row.others.size(), all);
  row.held = row.others.empty() ? Held::kYes : Held::kNo;
  return row;
}

Result<FidelityRow> starts_row(Imported& imported, const std::string& original) {
  constexpr double kPlace = 1e-9, kTurn = 1e-8;
  FidelityRow row{"starts",  "1e-9 m, 1e-8 rad",
                  "",        "what plans begin with against the stored states, read once more",
                  Held::kNo, {}};
  PROBE_ASSIGN(const fs::path root, root_of(original));
  std::size_t starts = 0, equal = 0, missing = 0;  // tasks without any start
  double place = 0, turn = 0;
  PROBE_TRY(each_task(root, [&](const OriginalTask& task) -> Status {
    PROBE_ASSIGN(const bool is_there, imported.has(task.suite->folder, task.name()));
    if (!is_there) {
      ++missing;
      row.others.push_back(task.key() + ": is not in the import");
      return {};
    }
    PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite->folder));
    const auto index = plan->find_task(task.name());
    const plan::TaskRecord& record = plan->tasks()[*index];
    const plan::SceneRecord& scene = plan->scenes()[record.scene];
    // Fixtures of the scene are those of the problem in their order, but for what carries all.
    JointsOf joints_of;
    std::size_t next = 0;
    const auto fixtures = plan->fixtures(scene);
    for (const BddlThing& thing : task.problem.fixtures) {
      const bool carries = std::ranges::any_of(task.problem.regions, [&](const BddlRegion& region) {
        return region.target == thing.name && !region.ranges.empty();
      });
      if (carries || next >= fixtures.size()) continue;
      std::vector<std::string>& names = joints_of[thing.category];
      names.clear();
      for (const auto& joint : plan->joints(plan->fixtures()[fixtures[next]]))
        names.emplace_back(plan->text(joint.joint));
      ++next;
    }
    PROBE_ASSIGN(
        const StartStates states,
        read_states(
            (root / "init_files" / task.suite->folder / (task.stem + ".pruned_init")).string(),
            task.problem, joints_of));
    const auto episodes = plan->episodes(record);
    const auto bodies = plan->bodies(record);
    for (std::size_t i = 0; i < states.starts.size(); ++i, ++starts) {
      if (i >= episodes.size()) {
        row.others.push_back(fmt::format("{}, start {}: is not in the import", task.key(), i));
        continue;
      }
      const StartState& stored = states.starts[i];
      double here_place = 0, here_turn = 0;
      bool is_whole = true;
      const auto placed = plan->placements(episodes[i]);
      for (std::size_t k = 0; k < stored.objects.size(); ++k) {
        const std::string& wanted = task.problem.objects[k].name;
        std::size_t at = 0;
        while (at < placed.size() && plan->text(bodies[at].name) != wanted) ++at;
        is_whole = is_whole && at < placed.size();
        if (at >= placed.size()) continue;
        for (std::size_t c = 0; c < 3; ++c)
          here_place =
              worse(here_place, std::abs(placed[at].position[c] - stored.objects[k].position[c]));
        const auto &p = placed[at].rotation, &q = stored.objects[k].rotation;
        // Either sign is the same turn, and a plan's quaternion has length 1.
        double length = 0, dot = 0;
        for (std::size_t c = 0; c < 4; ++c) length += q[c] * q[c], dot += p[c] * q[c];
        for (std::size_t c = 0; c < 4; ++c)
          here_turn =
              worse(here_turn, std::abs(p[c] - std::copysign(1, dot) * q[c] / std::sqrt(length)));
      }
      const auto arm = plan->joints(scene, episodes[i]);
      for (std::size_t k = 0; k < 7; ++k)
        here_turn = worse(here_turn, std::abs(arm[k] - stored.arm[k]));
      here_place = worse(here_place, std::abs(arm[7] - stored.fingers[0]));
      here_place = worse(here_place, std::abs(arm[8] + stored.fingers[1]));
      const std::vector<double> joints = plan::joint_starts_of(plan->tables(), scene, episodes[i]);
      is_whole = is_whole && joints.size() == stored.joints.size();
      for (std::size_t k = 0; k < std::min(joints.size(), stored.joints.size()); ++k)
        here_turn = worse(here_turn, std::abs(joints[k] - stored.joints[k]));
      place = worse(place, here_place);
      turn = worse(turn, here_turn);
      if (is_whole && here_place <= kPlace && here_turn <= kTurn) {
        ++equal;
      } else {
        row.others.push_back(fmt::format("{}, start {}", task.key(), i));
      }
    }
    return {};
  }));
  if (starts + missing == 0) {
    row.how = "the folder has no stored start";
    row.held = Held::kNotMeasured;
    return row;
  }
  row.figure = fmt::format("{} of {}; at most {:.1g} m, {:.1g} rad", equal, starts, place, turn);
  if (missing > 0)
    row.figure += fmt::format("; {} task{} not imported", missing, missing == 1 ? "" : "s");
  row.held = missing == 0 && equal == starts ? Held::kYes : Held::kNo;
  return row;
}

}  // namespace probe::libero
