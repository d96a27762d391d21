// A scripted policy in many starts of many tasks, without pictures, which it does not look at: what
// it makes of each, a line a start, and a table of the tasks with the starts that failed and why.
// No run: nothing of it is stored beside the rows, which say that no picture was drawn.
//
//   starts FILE.probe.. --assets DIR [--suite NAME] [--policy expert] [--tasks GLOB]
//     [--starts 0,11,30-35] [--jobs 2] [-o rows.csv] [--watch]
//
// Without --suite: all starts of all tasks of all suites of each file; with it those that the suite
// has, of which it may have drawn some. GLOB is of names without a suite's prefix.
// --watch tells of every tenth step where the tool, the objects and the joints of fixtures are.
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "compiler/diag/text.h"
#include "runtime/base/result.h"
#include "runtime/compile/files.h"
#include "runtime/plan/plan.h"
#include "runtime/run/episode.h"
#include "runtime/run/policies.h"
#include "runtime/stage/stage.h"

namespace probe {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string assets, suite, policy = "expert", tasks = "*", starts, out;
  int jobs = 1;
  bool watches = false;
};

struct Job {
  std::size_t plan = 0;
  std::uint32_t task = 0, start = 0;
};

// What became of a start.
struct Row {
  std::string status;  // "success", "failed", "not attempted", "invalid"
  int steps = 0;
  std::map<std::string, bool> metrics;
  std::string reason, state;
};

Failure usage(const std::string& what) { return {Fault::kUsage, what, ""}; }

Result<Options> read_options(int count, char** words) {
  Options out;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const std::map<std::string, std::string*> texts = {
        {"--assets", &out.assets}, {"--suite", &out.suite},   {"--policy", &out.policy},
        {"--tasks", &out.tasks},   {"--starts", &out.starts}, {"-o", &out.out}};
    if (word == "--watch") {
      out.watches = true;
    } else if (texts.contains(word) || word == "--jobs") {
      if (i + 1 >= count) return usage(word + " says nothing");
      const std::string value = words[++i];
      if (word == "--jobs")
        out.jobs = std::max(1, std::atoi(value.c_str()));
      else
        *texts.at(word) = value;
    } else if (word.starts_with("-")) {
      return usage("unknown option " + word);
    } else {
      out.files.push_back(word);
    }
  }
  if (out.files.empty()) return usage("no .probe file is named");
  return out;
}

// "0,11,30-35"; nothing: all.
Result<std::vector<bool>> chosen(const std::string& text, std::size_t count) {
  std::vector<bool> out(count, text.empty());
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    std::size_t first = 0, last = 0;
    auto read = std::from_chars(at, end, first);
    if (read.ec != std::errc()) return usage("no start: " + std::string(at, end));
    last = first;
    if (read.ptr < end && *read.ptr == '-') read = std::from_chars(read.ptr + 1, end, last);
    if (read.ec != std::errc() || (read.ptr < end && *read.ptr != ','))
      return usage("no start: " + std::string(at, end));
    for (std::size_t i = first; i <= last && i < count; ++i) out[i] = true;
    at = read.ptr < end ? read.ptr + 1 : end;
  }
  return out;
}

void watch(const stage::Stage& stage, const policy::Observation& seen) {
  if (stage.steps() % 10 != 0) return;
  const policy::Privileged& view = *seen.privileged;
  const Vec3 tool = (view.base * seen.proprioception.tcp_in_base).position;
  std::string line = fmt::format("{:3d} tool {:.3f} {:.3f} {:.3f} open {:.2f} |", stage.steps(),
                                 tool.x(), tool.y(), tool.z(), seen.proprioception.openness);
  for (const policy::PrivilegedObject& object : view.objects) {
    const Vec3& at = object.pose.position;
    const Vec3 up = object.pose.rotation * Vec3::UnitZ();
    const bool held = std::ranges::count(object.finger_contact, true) > 0;
    line += fmt::format(" {}{} {:.3f} {:.3f} {:.3f} up {:.2f}", held ? "*" : "", object.name,
                        at.x(), at.y(), at.z(), up.z());
  }
  for (const policy::PrivilegedFixture& part : view.fixtures) {
    if (part.joint) line += fmt::format(" {} {:.3f}", part.name, part.joint->position);
  }
  fmt::print("{}\n", line);
}

Row play(stage::Stage& stage, const plan::Plan& plan, const Job& job, policy::Policy& policy,
         bool watches) {
  Row row;
  const plan::TaskRecord& task = plan.tasks()[job.task];
  const auto failed = [&](const Failure& failure) {
    row.status = failure.code == Fault::kNoSkill ? "not attempted" : "invalid";
    row.reason = to_text(failure);
  };
  const auto step = [&]() -> Status {
    PROBE_ASSIGN(const policy::Observation seen, stage.observe());
    if (watches) watch(stage, seen);
    PROBE_ASSIGN(const policy::Action action, policy.act(seen));
    return stage.step(action);
  };
  const auto whole = [&]() -> Status {
    PROBE_TRY(stage.reset(job.start));
    policy::EpisodeStart first = stage.introduction();
    first.draw_seed = run::draw_seed(first.seed, Sha256{plan.episodes(task)[job.start].episode_id});
    PROBE_TRY(policy.begin(first));
    while (!stage.done()) PROBE_TRY(step());
    return {};
  };
  const Status done = whole();
  bool success = false;
  for (std::uint32_t i = 0; i < stage.judge().metric_count(); ++i) {
    if (stage.judge().metric_type(i) != plan::MetricType::kBool) continue;
    row.metrics[stage.judge().metric_name(i)] = stage.judge().truth(i);
    if (stage.judge().metric_name(i) == "success") success = stage.judge().truth(i);
  }
  row.steps = stage.steps();
  row.state = to_hex(stage.state_hash()).substr(0, 16);
  policy.end({done.ok(), success, row.steps});
  row.status = success ? "success" : "failed";
  if (!done.ok()) {
    failed(done.failure());
  } else if (!success) {
    row.reason = policy.remark().value_or("it was done, and the goal does not hold");
  }
  return row;
}

std::string quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return '"' + text + '"';
}

bool is_member(const plan::Plan& plan, std::uint32_t task) {
  return std::ranges::any_of(plan.suites(), [&](const plan::SuiteRecord& suite) {
    return std::ranges::count(plan.members(suite), task) > 0;
  });
}

class Campaign {
 public:
  explicit Campaign(Options options) : options_(std::move(options)) {}

  Status prepare() {
    PROBE_ASSIGN(const run::PolicyChoice choice, run::choose_policy(options_.policy));
    choice_ = choice;
    for (const std::string& file : options_.files) {
      PROBE_ASSIGN(Compilation made, compile::compile_files({file}, {.assets = options_.assets,
                                                                     .suite = options_.suite,
                                                                     .tasks = options_.tasks}));
      if (!made.ok)
        return usage(file + " has errors:\n" + render_text(made.diagnostics, made.sources));
      PROBE_ASSIGN(plan::Plan plan, plan::Plan::from_bytes(std::move(made.plan)));
      plans_.push_back(std::move(plan));
    }
    for (std::size_t p = 0; p < plans_.size(); ++p) {
      for (std::uint32_t t = 0; t < plans_[p].tasks().size(); ++t) {
        const auto count = plans_[p].episodes(plans_[p].tasks()[t]).size();
        PROBE_ASSIGN(const std::vector<bool> wanted, chosen(options_.starts, count));
        for (const std::uint32_t s : starts_of(plans_[p], t)) {
          if (wanted[s]) jobs_.push_back({p, t, s});
        }
      }
    }
    if (jobs_.empty())
      return usage("no start of the files is of a task `" + options_.tasks +
                   (options_.starts.empty() ? "`" : "` and one of " + options_.starts));
    rows_.resize(jobs_.size());
    if (options_.out.empty()) return {};
    out_.open(options_.out);
    out_ << "# policy " << options_.policy << ", no pictures; plans";
    for (const plan::Plan& plan : plans_) out_ << ' ' << to_hex(plan.root());
    out_ << "\ntask,start,status,steps,intention,grasp,wrong,state,reason\n";
    if (!out_) return Failure{Fault::kIo, "cannot be written", options_.out};
    return {};
  }

  // Tasks one after another, the starts of each shared out: a world is made once a task and worker.
  Status work() {
    std::vector<std::thread> threads;
    for (int i = 0; i < options_.jobs; ++i) threads.emplace_back([this] { take_jobs(); });
    for (std::thread& thread : threads) thread.join();
    if (broken_) return *broken_;
    return {};
  }

  void print() const {
    std::map<std::pair<std::size_t, std::uint32_t>, std::vector<std::size_t>> by_task;
    for (std::size_t i = 0; i < jobs_.size(); ++i)
      by_task[{jobs_[i].plan, jobs_[i].task}].push_back(i);
    for (std::size_t p = 0; p < plans_.size(); ++p) {
      int all = 0, good = 0;
      for (const auto& [key, jobs] : by_task) {
        if (key.first != p) continue;
        const auto is_good = [&](std::size_t job) { return rows_[job].status == "success"; };
        const auto solved = std::ranges::count_if(jobs, is_good);
        all += static_cast<int>(jobs.size()), good += static_cast<int>(solved);
        fmt::print("{:3d} of {:3d}  {}\n", solved, jobs.size(), name_of(jobs_[jobs.front()]));
        std::map<std::string, std::string> reasons;
        for (const std::size_t job : jobs) {
          if (is_good(job)) continue;
          std::string& starts = reasons[rows_[job].status + ": " + rows_[job].reason];
          starts += (starts.empty() ? "" : ", ") + std::to_string(jobs_[job].start);
        }
        for (const auto& [reason, starts] : reasons)
          fmt::print("            start {}: {}\n", starts, reason);
      }
      fmt::print("{:3d} of {:3d}  {}\n\n", good, all, options_.files[p]);
    }
  }

 private:
  // A suite that is named brings what its tasks are compared with; that is not played.
  std::vector<std::uint32_t> starts_of(const plan::Plan& plan, std::uint32_t task) const {
    if (!options_.suite.empty()) {
      if (!is_member(plan, task)) return {};
      if (const auto suite = plan.find_suite(options_.suite))
        return plan.episodes(plan.suites()[*suite], task);
    }
    std::vector<std::uint32_t> all(plan.episodes(plan.tasks()[task]).size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }
  std::string name_of(const Job& job) const {
    const plan::Plan& plan = plans_[job.plan];
    return std::string(plan.text(plan.tasks()[job.task].name));
  }

  void take_jobs() {
    auto policy = run::make_policy(choice_);
    std::shared_ptr<const stage::SharedAssets> assets;
    std::unique_ptr<stage::Stage> stage;
    Job had;  // of `stage`
    const auto run = [&](std::size_t number) -> Status {
      const Job& job = jobs_[number];
      const plan::Plan& plan = plans_[job.plan];
      if (!stage || had.plan != job.plan || had.task != job.task) {
        stage.reset();
        PROBE_ASSIGN(assets, assets_of(job));
        PROBE_ASSIGN(stage, stage::Stage::create(plan, job.task, assets, {{}, false}));
        had = job;
      }
      keep(number, play(*stage, plan, job, **policy, options_.watches));
      return {};
    };
    if (!policy) return stop(policy.failure());
    for (std::size_t number = next_++; number < jobs_.size(); number = next_++) {
      if (const Status done = run(number); !done.ok()) return stop(done.failure());
    }
  }

  Result<std::shared_ptr<const stage::SharedAssets>> assets_of(const Job& job) {
    const std::lock_guard lock(mutex_);
    if (!loaded_ || loaded_for_.plan != job.plan || loaded_for_.task != job.task) {
      const std::uint32_t tasks[] = {job.task};
      PROBE_ASSIGN(loaded_, stage::SharedAssets::load(plans_[job.plan], options_.assets, tasks));
      loaded_for_ = job;
    }
    return loaded_;
  }

  void keep(std::size_t number, Row row) {
    const std::lock_guard lock(mutex_);
    const auto truth = [&](const char* metric) {
      return row.metrics.contains(metric) ? (row.metrics[metric] ? "true" : "false") : "";
    };
    if (out_.is_open()) {
      out_ << name_of(jobs_[number]) << ',' << jobs_[number].start << ',' << row.status << ','
           << row.steps << ',' << truth("intention") << ',' << truth("grasp") << ','
           << truth("wrong") << ',' << row.state << ',' << quoted(row.reason) << std::endl;
    }
    rows_[number] = std::move(row);
  }

  void stop(const Failure& failure) {
    const std::lock_guard lock(mutex_);
    if (!broken_) broken_ = failure;
    next_ = jobs_.size();
  }

  Options options_;
  run::PolicyChoice choice_;
  std::vector<plan::Plan> plans_;
  std::vector<Job> jobs_;
  std::vector<Row> rows_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  std::shared_ptr<const stage::SharedAssets> loaded_;
  Job loaded_for_;
  std::optional<Failure> broken_;
  std::ofstream out_;
};

Status run_all(int count, char** words) {
  PROBE_ASSIGN(Options options, read_options(count, words));
  Campaign campaign(std::move(options));
  PROBE_TRY(campaign.prepare());
  PROBE_TRY(campaign.work());
  campaign.print();
  return {};
}

}  // namespace
}  // namespace probe

int main(int count, char** words) {
  const probe::Status done = probe::run_all(count, words);
  if (done.ok()) return 0;
  std::fputs((probe::to_text(done.failure()) + "\n").c_str(), stderr);
  return 2;
}
