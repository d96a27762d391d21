#include "runtime/report/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "runtime/ask/answers.h"
#include "runtime/base/printable.h"
#include "runtime/inspect/axes.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/places.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/source_line.h"
#include "runtime/report/categories.h"
#include "runtime/run/delivery.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestText = 1000;  // of a name or reason that a run folder holds, bytes
constexpr std::size_t kNamed = 3;           // before the rest is only counted

std::string hex(const std::array<std::uint8_t, 32>& bytes) {
  return to_hex(plan::to_sha256(bytes));
}

// The index of `item` in `list`, appended if it is not there.
template <typename Item>
int index_in(std::vector<Item>& list, const Item& item) {
  const auto found = std::find(list.begin(), list.end(), item);
  if (found != list.end()) return static_cast<int>(found - list.begin());
  list.push_back(item);
  return static_cast<int>(list.size()) - 1;
}

int good_of(std::string_view metric) {
  for (const char* name : {"success", "intention", "grasp", "steady", "moved"}) {
    if (metric == name) return 1;
  }
  return metric == "wrong" ? -1 : 0;
}

// Begins what stands behind the name of a policy whose world did not wait for it: it is compared
// with the same policy in a world that does, and never joined to it.
constexpr std::string_view kLive = " (live, ";

Role role_of(std::string_view policy) {
  const std::string_view name = policy.substr(0, std::min(policy.find(':'), policy.find(kLive)));
  if (name == "expert") return Role::kCeiling;
  if (name == "null" || name == "idle") return Role::kFloor;
  if (name == "random") return Role::kRandom;
  if (name == "reach" || name == "wrong" || name == "noisy") return Role::kProbe;
  return Role::kModel;
}

double yaw_deg(const std::array<double, 4>& q) {
  const double yaw =
      std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  return yaw * 180 / std::numbers::pi;
}

class Loader {
 public:
  explicit Loader(const LoadOptions& options) : options_(options) {}

  Result<Benchmark> load(std::span<const std::string> dirs) {
    if (dirs.empty()) return Failure{Fault::kUsage, "no results folder is named", "DIR"};
    std::set<std::string> seen;
    for (const std::string& dir : dirs) {
      std::error_code error;
      const std::string same = fs::weakly_canonical(dir, error).string();
      if (!seen.insert(error ? dir : same).second) {
        note("note", fmt::format("`{}` is named twice and counts once", dir));
        continue;
      }
      PROBE_TRY(ask::holds_answers(dir) ? add_answers(dir) : add_folder(dir));
    }
    PROBE_TRY(all_empty(dirs));
    label_policies();
    label_models();
    mark_unchecked();
    finish();
    return std::move(benchmark_);
  }

 private:
  struct PlanTasks {
    std::vector<int> task;                // of the benchmark, by index in the plan
    std::vector<std::vector<int>> start;  // by task of the plan and index of the episode
  };

  void note(std::string level, std::string text) {
    benchmark_.notes.push_back({std::move(level), std::move(text)});
  }

  Status all_empty(std::span<const std::string> dirs) const {
    if (!benchmark_.episodes.empty() || !benchmark_.models.empty()) return {};
    std::string names;
    for (const std::string& dir : dirs) names += (names.empty() ? "" : ", ") + dir;
    return Failure{Fault::kUsage, "no episode has been run yet: there is nothing to report", names};
  }

  Status add_folder(const std::string& dir) {
    PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
    RunInfo info;
    PROBE_ASSIGN(std::vector<store::ResultRow> rows, rows_of(dir, &info.live));
    PROBE_ASSIGN(const int plan, plan_of(dir, record));
    info.dir = dir;
    info.plan = plan;
    info.content = record.identity.policy_content;
    info.fingerprint = index_in(benchmark_.fingerprints, record.fingerprint.entries);
    info.seeds = record.seeds;
    if (info.fingerprint > 0) {
      const store::Fingerprint first{benchmark_.fingerprints[0]};
      for (const std::string& line : store::differences(first, record.fingerprint)) {
        index_in(benchmark_.fingerprint_differences, line);
      }
    }
    add_rows(dir, record, plan, std::move(rows), info);
    return {};
  }

  Status add_answers(const std::string& dir) {
    PROBE_ASSIGN(const ask::AskRecord record, ask::read_ask_record(dir));
    PROBE_ASSIGN(plan::Plan asked, ask::open_asked_plan(dir));
    const int index = add_plan(std::move(asked), record.suite);
    PROBE_ASSIGN(AskedModel model,
                 read_asked_model(dir, benchmark_.plan_files[static_cast<std::size_t>(index)]));
    model.plan = index;
    model.name = printable(model.name, kLongestText);
    const PlanTasks& map = maps_[static_cast<std::size_t>(index)];
    for (AskedModel::Known& known : model.known) {
      const auto task = static_cast<std::size_t>(known.task);
      known.start = map.start[task][static_cast<std::size_t>(known.start)];
      known.task = map.task[task];
    }
    for (const std::string& finding : model.findings)
      note("bad", fmt::format("`{}`: {}", dir, finding));
    for (const std::string& doubt : model.doubts)
      note("bad", printable(fmt::format("`{}`: {}", dir, doubt), kLongestText));
    benchmark_.models.push_back(std::move(model));
    return {};
  }

  // `live`: of a run whose world does not wait, how its policy answered.
  Result<std::vector<store::ResultRow>> rows_of(const std::string& dir, std::string* live) {
    constexpr std::size_t kTold = 5;
    if (!options_.prove) return store::read_results(dir);
    PROBE_ASSIGN(store::ProvenResults proven, store::read_proven_results(dir));
    const auto& refused = proven.refused;
    for (std::size_t i = 0; i < refused.size() && i < kTold; ++i) {
      note("bad", printable(refused[i], kLongestText));
    }
    if (refused.size() > kTold) {
      note("bad", fmt::format("{} more rows of `{}` are left out, because their traces do not bear "
                              "them",
                              refused.size() - kTold, dir));
    }
    if (!proven.live_terms.empty()) *live = to_text(proven.live);
    return std::move(proven.rows);
  }

  // Opens the folder's plan, or finds the one with the same root.
  Result<int> plan_of(const std::string& dir, const store::RunRecord& record) {
    auto plan = store::open_run_plan(dir);
    if (!plan) return plan.failure();
    const std::string root = to_hex(plan->root());
    if (root != record.identity.plan_root) {
      return Failure{Fault::kStore, "the folder's plan is not the one its results were made with",
                     store::plan_path(dir)};
    }
    return add_plan(std::move(plan).value(), record.suite);
  }

  // Its index, or that of an equal one that is there.
  int add_plan(plan::Plan plan, const std::string& suite_name) {
    const std::string root = to_hex(plan.root());
    for (std::size_t i = 0; i < benchmark_.plans.size(); ++i) {
      if (benchmark_.plans[i].root == root && benchmark_.plans[i].suite == suite_name)
        return static_cast<int>(i);
    }
    PlanInfo info{root, suite_name, "", 0, 0, 1};
    const auto suite = plan.find_suite(suite_name);
    if (suite) {
      info.trained_on = plan.text(plan.suites()[*suite].trained_on);
      info.seeds = static_cast<int>(plan.seeds(plan.suites()[*suite]).size());
    }
    std::vector<std::uint32_t> members;
    if (suite) {
      const auto of_suite = plan.members(plan.suites()[*suite]);
      members.assign(of_suite.begin(), of_suite.end());
    } else {
      for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) members.push_back(t);
    }
    info.tasks = static_cast<int>(members.size());
    for (const std::uint32_t t : members) {
      info.starts += static_cast<int>(plan.episodes(plan.tasks()[t]).size());
    }
    benchmark_.plans.push_back(std::move(info));
    benchmark_.plan_files.push_back(std::move(plan));
    members_.push_back(std::move(members));
    add_tasks(static_cast<int>(benchmark_.plans.size()) - 1);
    return static_cast<int>(benchmark_.plans.size()) - 1;
  }

  int metric(const std::string& name, bool truth) {
    for (std::size_t i = 0; i < benchmark_.metrics.size(); ++i) {
      if (benchmark_.metrics[i].name == name) return static_cast<int>(i);
    }
    benchmark_.metrics.push_back({name, truth, truth ? good_of(name) : 0});
    return static_cast<int>(benchmark_.metrics.size()) - 1;
  }

  int object(const plan::Plan& plan, std::uint32_t index) {
    const std::string name(plan.text(plan.objects()[index].name));
    for (std::size_t i = 0; i < benchmark_.objects.size(); ++i) {
      if (benchmark_.objects[i].name == name) return static_cast<int>(i);
    }
    benchmark_.objects.push_back({name, std::nullopt, std::nullopt});
    return static_cast<int>(benchmark_.objects.size()) - 1;
  }

  void add_tasks(int index) {
    const plan::Plan& plan = benchmark_.plan_files[static_cast<std::size_t>(index)];
    PlanTasks map;
    map.task.resize(plan.tasks().size(), kAbsent);
    map.start.resize(plan.tasks().size());
    for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) add_task(plan, index, t, map);
    for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
      const std::uint32_t baseline = plan.tasks()[t].baseline;
      Task& task = benchmark_.tasks[static_cast<std::size_t>(map.task[t])];
      if (task.plan == index && baseline != plan::kNone) task.baseline = map.task[baseline];
    }
    maps_.push_back(std::move(map));
  }

  // Empty where there is none.
  static std::string object_name(const plan::Plan& plan, std::uint32_t object) {
    return object == plan::kNone ? "" : std::string(plan.text(plan.objects()[object].name));
  }

  void add_task(const plan::Plan& plan, int index, std::uint32_t t, PlanTasks& map) {
    const plan::TaskRecord& record = plan.tasks()[t];
    const std::string name(plan.text(record.name));
    const auto key = std::tuple(name, std::string(plan.text(record.prompt)), hex(record.judge_id),
                                object_name(plan, record.source), object_name(plan, record.target));
    const auto [known, fresh] = by_content_.try_emplace(key, benchmark_.tasks.size());
    map.task[t] = static_cast<int>(known->second);
    if (fresh) benchmark_.tasks.push_back(describe(plan, index, t));
    Task& task = benchmark_.tasks[known->second];
    for (const plan::EpisodeRecord& episode : plan.episodes(record)) {
      const std::string id = hex(episode.episode_id);
      auto at = std::find_if(task.starts.begin(), task.starts.end(),
                             [&](const StartPlace& start) { return start.episode_id == id; });
      if (at == task.starts.end()) {
        task.starts.push_back(place(plan, record, episode));
        at = task.starts.end() - 1;
      }
      map.start[t].push_back(static_cast<int>(at - task.starts.begin()));
    }
  }

  StartPlace place(const plan::Plan& plan, const plan::TaskRecord& task,
                   const plan::EpisodeRecord& episode) {
    StartPlace place;
    place.start_id = hex(episode.start_id);
    place.episode_id = hex(episode.episode_id);
    for (const plan::PlacementRecord& body : plan.placements(episode))
      place.bodies.push_back({body.position[0], body.position[1], yaw_deg(body.rotation)});
    place.cluster = clusters_
                        .try_emplace(plan::place_key(plan, task, episode),
                                     static_cast<std::uint32_t>(clusters_.size()))
                        .first->second;
    return place;
  }

  Task describe(const plan::Plan& plan, int index, std::uint32_t t) {
    const plan::TaskRecord& record = plan.tasks()[t];
    Task task;
    task.name = plan.text(record.name);
    for (const Task& other : benchmark_.tasks) {
      if (other.name != task.name) continue;
      task.name = name_apart(task.name, to_hex(plan.root()));
      two_meanings_.push_back(other.name);
      break;
    }
    task.prompt = plan.text(record.prompt);
    index_in(benchmark_.prompts, task.prompt);
    task.plan = index;
    task.axes = record.axes;
    task.axis_names = plan::moved_axes(plan.tables(), record);
    const plan::TaskRoles roles = plan::roles_of(plan.tables(), record);
    const auto objects_of = [&](std::uint32_t first, std::uint32_t count) {
      std::vector<int> objects;
      for (const plan::BodyRecord& body : plan.bodies(record).subspan(first, count))
        objects.push_back(object(plan, body.index));
      return objects;
    };
    if (roles.has_source()) task.source = object(plan, record.source);
    if (roles.has_target()) task.target = object(plan, record.target);
    for (const plan::RoleRecord& role : roles.others)
      task.roles.push_back({std::string(plan.text(role.name)), objects_of(role.first, role.count)});
    task.distractors = objects_of(roles.distractors.first, roles.distractors.count);
    for (std::size_t bit = 0; bit < plan::kNovelty.size(); ++bit) {
      if ((record.ood >> bit & 1U) != 0) task.ood.emplace_back(plan::kNovelty[bit]);
    }
    if (roles.has_source())
      benchmark_.objects[static_cast<std::size_t>(task.source)].seen_as_source =
          (record.ood & 1U) == 0;
    if (roles.has_target())
      benchmark_.objects[static_cast<std::size_t>(task.target)].seen_as_target =
          (record.ood & 2U) == 0;
    const plan::SceneRecord& scene = plan.scenes()[record.scene];
    task.scene = plan.text(scene.name);
    task.horizon = static_cast<int>(record.horizon);
    task.hz = plan.robots()[scene.robot].control_hz;
    for (const plan::MetricRecord& m : plan.metrics(record)) {
      const std::string name(plan.text(m.name));
      task.metrics.push_back(
          metric(name, m.type == static_cast<std::uint32_t>(plan::MetricType::kBool)));
      if (name == "success") quote_rule(plan, m, task);
    }
    task.allowed = plan.text(record.allow);
    if (record.baseline != plan::kNone && std::popcount(record.axes) > 1) {
      std::string axes;
      for (const std::string& axis : task.axis_names) axes += (axes.empty() ? "" : ", ") + axis;
      task.confounded =
          fmt::format("moves {} at once{}{}", axes, task.allowed.empty() ? "" : ": ", task.allowed);
    }
    return task;
  }

  static void quote_rule(const plan::Plan& plan, const plan::MetricRecord& metric, Task& task) {
    const auto index = static_cast<std::uint32_t>(&metric - plan.metrics().data());
    const plan::SpanRecord* span = plan.span_of(plan::SpanKind::kMetrics, index);
    if (span == nullptr) return;
    const plan::TextRecord& text = plan.texts()[span->text];
    const plan::SourceLine line = plan::line_at(plan.tables().source(text), span->begin);
    task.rule_file = plan.tables().path(text);
    task.rule_line = static_cast<int>(line.number);
    task.rule = line.text;
  }

  void add_rows(const std::string& dir, const store::RunRecord& record, int plan,
                std::vector<store::ResultRow> rows, RunInfo& info) {
    const plan::Plan& file = benchmark_.plan_files[static_cast<std::size_t>(plan)];
    const PlanTasks& map = maps_[static_cast<std::size_t>(plan)];
    note_delivery(dir, file, rows);
    note_reading(dir, info);
    std::vector<Episode> episodes;
    std::set<int> tasks;
    std::size_t unknown = 0;
    for (store::ResultRow& row : rows) {
      const auto task = file.find_task(row.task);
      if (!task || row.episode < 0 ||
          static_cast<std::size_t>(row.episode) >= map.start[*task].size()) {
        ++unknown;
        continue;
      }
      Episode episode;
      episode.task = map.task[*task];
      episode.start = map.start[*task][static_cast<std::size_t>(row.episode)];
      episode.plan = plan;
      if (row.invalid) {
        episode.reason = index_in(benchmark_.reasons, printable(*row.invalid, kLongestText));
        ++(store::is_not_attempted(row) ? info.not_attempted : info.invalid);
      } else {
        for (const store::MetricValue& value : row.metrics) {
          const int m = metric(value.name, value.is_bool);
          if (value.is_bool && value.value != 0) set_true(episode.truths, m);
        }
      }
      episode.prompt = prompt_of(row.sent_prompt_sha256.value_or(row.prompt_sha256));
      const fs::path video =
          fs::path(dir) / "videos" / row.task / fmt::format("{}-{}.mp4", row.episode, row.seed);
      if (std::error_code ignored; fs::exists(video, ignored)) {
        episode.video = video.string();
        ++info.videos;
      }
      tasks.insert(episode.task);
      episode.row = std::move(row);
      episodes.push_back(std::move(episode));
    }
    if (unknown > 0) {
      note("warn", fmt::format("{} rows of `{}` name tasks or starts that its plan does not have; "
                               "they are left out",
                               unknown, dir));
    }
    info.done = static_cast<int>(episodes.size());
    info.tasks = static_cast<int>(tasks.size());
    const PlanInfo& of_plan = benchmark_.plans[static_cast<std::size_t>(plan)];
    info.expected =
        of_plan.starts * static_cast<int>(std::max<std::size_t>(1, record.seeds.size()));
    std::string name = printable(record.identity.policy, kLongestText);
    if (!record.identity.live.empty())
      name += " (" + printable(record.identity.live, kLongestText) + ")";
    place_run(name, std::move(info), std::move(episodes));
  }

  int prompt_of(const std::string& hash) {
    while (hashed_ < benchmark_.prompts.size()) {
      prompt_hashes_.emplace(to_hex(probe::sha256(benchmark_.prompts[hashed_])),
                             static_cast<int>(hashed_));
      ++hashed_;
    }
    const auto found = prompt_hashes_.find(hash);
    return found == prompt_hashes_.end() ? kAbsent : found->second;
  }

  // Joins a run to a policy of its name whose episodes are others, as shards' are.
  void place_run(const std::string& name, RunInfo info, std::vector<Episode> episodes) {
    using Key = std::tuple<int, int, int>;
    std::set<Key> keys;
    for (const Episode& e : episodes) keys.emplace(e.task, e.start, e.row.seed);
    std::size_t policy = options_.join ? 0 : benchmark_.policies.size();
    for (; policy < benchmark_.policies.size(); ++policy) {
      if (benchmark_.policies[policy].name != name) continue;
      const auto& held = held_[policy];
      if (std::none_of(keys.begin(), keys.end(), [&](const Key& k) { return held.contains(k); }))
        break;
    }
    if (policy == benchmark_.policies.size()) {
      benchmark_.policies.push_back({name, name, role_of(name), {}});
      held_.emplace_back();
    }
    held_[policy].insert(keys.begin(), keys.end());
    for (Episode& e : episodes) {
      e.policy = static_cast<int>(policy);
      benchmark_.episodes.push_back(std::move(e));
    }
    benchmark_.policies[policy].runs.push_back(std::move(info));
  }

  void label_models() {
    for (AskedModel& model : benchmark_.models) {
      const auto same = std::ranges::count(benchmark_.models, model.name, &AskedModel::name);
      model.label = same < 2
                        ? model.name
                        : fmt::format("{} ({})", model.name, printable(model.dir, kLongestText));
    }
  }

  // Tables have no notes: what nobody vouches for is told by its name there.
  void mark_unchecked() {
    for (AskedModel& model : benchmark_.models) {
      if (model.is_unchecked) model.label += " (--insecure)";
    }
    for (Policy& policy : benchmark_.policies) {
      if (std::ranges::any_of(policy.runs,
                              [](const RunInfo& run) { return run.reading.is_unchecked; }))
        policy.label += " (--insecure)";
    }
  }

  void label_policies() {
    for (Policy& policy : benchmark_.policies) {
      const auto same =
          std::count_if(benchmark_.policies.begin(), benchmark_.policies.end(),
                        [&](const Policy& other) { return other.name == policy.name; });
      if (same < 2 || policy.runs.empty()) continue;
      policy.label =
          fmt::format("{} ({})", policy.name, printable(policy.runs[0].dir, kLongestText));
      const auto first =
          std::find_if(benchmark_.policies.begin(), benchmark_.policies.end(),
                       [&](const Policy& other) { return other.name == policy.name; });
      if (&*first == &policy) {
        note("note", fmt::format("policy `{}` was run more than once; its runs stand apart, each "
                                 "with its folder",
                                 policy.name));
      }
    }
  }

  void note_two_meanings() {
    if (two_meanings_.empty()) return;
    std::string names;
    for (std::size_t i = 0; i < two_meanings_.size() && i < kNamed; ++i)
      names += (i == 0 ? "`" : ", `") + two_meanings_[i] + "`";
    if (two_meanings_.size() > kNamed)
      names += fmt::format(" and {} more", two_meanings_.size() - kNamed);
    note("warn",
         fmt::format("{} tasks mean different things in different plans (another instruction, rule "
                     "or object) and are shown apart: {}",
                     two_meanings_.size(), names));
  }

  // What was meant to differ and reached the policy equal.
  void note_delivery(const std::string& dir, const plan::Plan& plan,
                     std::span<const store::ResultRow> rows) {
    const auto findings = run::check_delivery(plan, rows);
    for (std::size_t i = 0; i < findings.size() && i < kNamed; ++i)
      note("bad", fmt::format("`{}`: {}", dir, findings[i].sentence));
    if (findings.size() > kNamed) {
      note("bad",
           fmt::format("`{}`: {} more findings of that kind; `vlaprobe results {} --delivery` "
                       "lists them",
                       dir, findings.size() - kNamed, dir));
    }
  }

  // What the questions at the beginning of its calls showed. A folder whose calls cannot be read
  // has been told of with its rows.
  void note_reading(const std::string& dir, RunInfo& info) {
    const auto calls = store::read_run_calls(dir);
    if (!calls) return;
    info.reading = store::summarize_readings(*calls);
    for (const std::string& finding : info.reading.findings)
      note("bad", fmt::format("`{}`: {}", dir, finding));
  }

  void note_runs() {
    note_two_meanings();
    for (const Policy& policy : benchmark_.policies) {
      int done = 0, invalid = 0, not_attempted = 0, expected = 0;
      for (const RunInfo& run : policy.runs) {
        done += run.done;
        invalid += run.invalid;
        not_attempted += run.not_attempted;
        expected = std::max(expected, run.expected);
      }
      if (done < expected) {
        note("warn", fmt::format("`{}` is partial: {} of {} episodes of the suite; only starts "
                                 "that both sides have are compared",
                                 policy.label, done, expected));
      }
      if (not_attempted > 0) {
        note("note",
             fmt::format("`{}`: {} of {} episodes were not attempted: no solution in skills "
                         "for their goal",
                         policy.label, not_attempted, done));
      }
      if (invalid > 0) {
        note(invalid == done ? "bad" : "warn",
             fmt::format("`{}`: {} of {} episodes are invalid and count neither way", policy.label,
                         invalid, done));
      }
    }
    std::set<std::string> roots;
    for (const PlanInfo& plan : benchmark_.plans) roots.insert(plan.root);
    if (roots.size() > 1) {
      note("warn", fmt::format("the runs are of {} plans; tasks are joined where instruction, rule "
                               "and objects agree, and compared on common starts only",
                               roots.size()));
    }
    for (const std::string& line : benchmark_.fingerprint_differences)
      note("note", "the runs' builds or machines differ: " + line);
  }

  void finish() {
    order_metrics();
    drop_unused_tasks();
    for (Task& task : benchmark_.tasks) mark_pairing(task);
    index_episodes(benchmark_);
    find_categories(benchmark_, options_.sets);
    note_runs();
  }

  static void set_true(std::vector<bool>& truths, int metric) {
    const auto at = static_cast<std::size_t>(metric);
    if (at >= truths.size()) truths.resize(at + 1);
    truths[at] = true;
  }

  // Truths first, so that they are bits; numbers stay in the rows.
  void order_metrics() {
    std::vector<int> order(benchmark_.metrics.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return benchmark_.metrics[static_cast<std::size_t>(a)].truth >
             benchmark_.metrics[static_cast<std::size_t>(b)].truth;
    });
    std::vector<int> now(order.size());
    std::vector<Metric> metrics;
    for (std::size_t i = 0; i < order.size(); ++i) {
      now[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
      metrics.push_back(benchmark_.metrics[static_cast<std::size_t>(order[i])]);
    }
    benchmark_.metrics = std::move(metrics);
    for (Task& task : benchmark_.tasks) {
      for (int& m : task.metrics) m = now[static_cast<std::size_t>(m)];
    }
    for (Episode& e : benchmark_.episodes) {
      std::vector<bool> truths;
      for (std::size_t i = 0; i < e.truths.size(); ++i) {
        if (e.truths[i]) set_true(truths, now[i]);
      }
      e.truths = std::move(truths);
    }
  }

  // Tasks that no run's suite lists and no episode is of; baselines of the others stay.
  void drop_unused_tasks() {
    std::vector<bool> used(benchmark_.tasks.size(), false);
    for (const Episode& e : benchmark_.episodes) used[static_cast<std::size_t>(e.task)] = true;
    for (const AskedModel& model : benchmark_.models) {
      for (const AskedModel::Known& known : model.known)
        used[static_cast<std::size_t>(known.task)] = true;
    }
    for (std::size_t p = 0; p < maps_.size(); ++p) {
      for (const std::uint32_t t : members_[p])
        used[static_cast<std::size_t>(maps_[p].task[t])] = true;
    }
    for (std::size_t t = benchmark_.tasks.size(); t-- > 0;) {
      for (int b = static_cast<int>(t); used[t] && b != kAbsent;
           b = benchmark_.tasks[static_cast<std::size_t>(b)].baseline)
        used[static_cast<std::size_t>(b)] = true;
    }
    std::vector<int> now(used.size(), kAbsent);
    std::vector<Task> tasks;
    for (std::size_t t = 0; t < used.size(); ++t) {
      if (!used[t]) continue;
      now[t] = static_cast<int>(tasks.size());
      tasks.push_back(std::move(benchmark_.tasks[t]));
    }
    for (Task& task : tasks) {
      if (task.baseline != kAbsent) task.baseline = now[static_cast<std::size_t>(task.baseline)];
    }
    for (Episode& e : benchmark_.episodes) e.task = now[static_cast<std::size_t>(e.task)];
    for (AskedModel& model : benchmark_.models) {
      for (AskedModel::Known& known : model.known)
        known.task = now[static_cast<std::size_t>(known.task)];
    }
    benchmark_.tasks = std::move(tasks);
  }

  void mark_pairing(Task& task) const {
    if (task.baseline == kAbsent) return;
    const Task& baseline = benchmark_.tasks[static_cast<std::size_t>(task.baseline)];
    if (baseline.scene != task.scene) {
      task.unpaired =
          fmt::format("it is in scene {}, the baseline in {}", task.scene, baseline.scene);
      return;
    }
    if (baseline.starts.size() != task.starts.size()) {
      task.unpaired = fmt::format("it has {} starts, the baseline {}", task.starts.size(),
                                  baseline.starts.size());
      return;
    }
    for (std::size_t s = 0; s < task.starts.size(); ++s) {
      if (task.starts[s].cluster == baseline.starts[s].cluster) continue;
      task.unpaired = "its objects start in other places than the baseline's";
      return;
    }
  }

  using TaskKey = std::tuple<std::string, std::string, std::string, std::string, std::string>;

  const LoadOptions& options_;
  Benchmark benchmark_;
  std::vector<std::vector<std::uint32_t>> members_;  // by plan: tasks of its suite
  std::vector<PlanTasks> maps_;                      // by plan
  std::map<TaskKey, std::size_t> by_content_;
  std::map<std::string, std::uint32_t> clusters_;
  std::vector<std::string> two_meanings_;
  std::map<std::string, int> prompt_hashes_;
  std::size_t hashed_ = 0;
  std::vector<std::set<std::tuple<int, int, int>>> held_;  // by policy
};

}  // namespace

std::string name_apart(const std::string& task, const std::string& root) {
  return fmt::format("{} (plan {})", task, root.substr(0, 8));
}

std::string_view to_text(Role role) {
  switch (role) {
    case Role::kModel:
      return "model";
    case Role::kCeiling:
      return "ceiling";
    case Role::kFloor:
      return "floor";
    case Role::kRandom:
      return "random";
    case Role::kProbe:
      return "probe";
  }
  return "";
}

int Benchmark::find_metric(std::string_view name) const {
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    if (metrics[i].name == name && metrics[i].truth) return static_cast<int>(i);
  }
  return kAbsent;
}

int Benchmark::find_task(std::string_view name) const {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].name == name) return static_cast<int>(i);
  }
  return kAbsent;
}

std::span<const Episode> Benchmark::of(int policy, int task) const {
  const std::size_t cell =
      static_cast<std::size_t>(policy) * tasks.size() + static_cast<std::size_t>(task);
  return std::span(episodes).subspan(first[cell], first[cell + 1] - first[cell]);
}

std::vector<int> Benchmark::all_tasks() const {
  std::vector<int> all(tasks.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return all;
}

void index_episodes(Benchmark& benchmark) {
  std::stable_sort(benchmark.episodes.begin(), benchmark.episodes.end(),
                   [](const Episode& a, const Episode& b) {
                     return std::tuple(a.policy, a.task, a.start, a.row.seed) <
                            std::tuple(b.policy, b.task, b.start, b.row.seed);
                   });
  const std::size_t cells = benchmark.policies.size() * benchmark.tasks.size();
  benchmark.first.assign(cells + 1, 0);
  for (const Episode& e : benchmark.episodes) {
    ++benchmark.first[static_cast<std::size_t>(e.policy) * benchmark.tasks.size() +
                      static_cast<std::size_t>(e.task) + 1];
  }
  for (std::size_t i = 0; i < cells; ++i) benchmark.first[i + 1] += benchmark.first[i];
}

Result<Benchmark> load(std::span<const std::string> dirs, const LoadOptions& options) {
  return Loader(options).load(dirs);
}

}  // namespace probe::report
