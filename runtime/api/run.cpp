// Runs, and what is told of them.
#include "runtime/run/run.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/api/calls.h"
#include "runtime/api/folders.h"
#include "runtime/api/plan.h"
#include "runtime/api/questions.h"
#include "runtime/assets/output_file.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/rejudge/explain.h"
#include "runtime/rejudge/explain_json.h"
#include "runtime/report/compare_folders.h"
#include "runtime/report/report_page.h"
#include "runtime/run/replay.h"
#include "runtime/store/callers_policy.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/run_record.h"
#include "runtime/store/store.h"

using namespace probe;
using api::call;
using api::give;
using api::give_text;
using api::text_of;

namespace {

Result<run::RunOptions> read(const vlaprobe_run_options& given, const api::SharedPlan& plan) {
  run::RunOptions options;
  options.out = text_of(given.out);
  options.policy = text_of(given.policy);
  options.name = text_of(given.name);
  options.suite = text_of(given.suite);
  options.assets = plan.asset_root();
  if (given.tasks != nullptr) options.tasks = given.tasks;
  options.originals = given.originals != 0;
  if (options.out.empty()) return api::usage("a run has a folder to write to: `out`");
  if (given.has_episodes != 0) {
    PROBE_ASSIGN(options.episodes, api::read_episodes(given.first_episode, given.last_episode));
  }
  if (given.seed_count > 0) PROBE_TRY(api::needs({{given.seeds, "seeds"}}));
  for (std::size_t i = 0; i < given.seed_count; ++i) {
    if (given.seeds[i] < 0)
      return api::usage("a seed is a whole number from 0 on, found " +
                        std::to_string(given.seeds[i]));
    options.seeds.push_back(given.seeds[i]);
  }
  PROBE_ASSIGN(options.jobs, api::read_jobs(given.jobs, "worlds"));
  PROBE_ASSIGN(options.if_changed, api::read_if_changed(given.if_changed));
  if (given.videos < VLAPROBE_NO_VIDEOS || given.videos > VLAPROBE_ALL_VIDEOS)
    return api::usage("there is no choice of videos " + std::to_string(given.videos));
  options.video = static_cast<run::VideoChoice>(given.videos);
  if (given.until != nullptr) PROBE_TRY(run::set_until(given.until, options));
  return options;
}

static_assert(static_cast<int>(run::VideoChoice::kFailures) == VLAPROBE_FAILURES);

// A policy of the caller's in place of one of ours.
Status use_callback(const vlaprobe_run_options& given, const std::function<bool()>& stopped,
                    run::RunOptions& options) {
  if (!options.policy.empty())
    return api::usage("either `policy` or `act` answers: both were given");
  if (options.name.empty()) return api::usage("a policy of the caller's has a `name`");
  if (given.batch < 0) return api::usage("a batch has at least one question");
  if (!(given.gather_s >= 0 && given.gather_s <= 3600))
    return api::usage("a question waits 0 to 3600 seconds for others: `gather_s`");
  options.policy = options.name;
  // What fails in a callback would only fail again; it is stored with its reason.
  options.retries = 0;
  options.give_up_after = 0;
  constexpr double kGather = 0.1;
  auto questions = std::make_shared<api::Questions>(api::AskOptions{
      .act = given.act,
      .user = given.user,
      .most = static_cast<std::size_t>(given.batch == 0 ? options.jobs : given.batch),
      .gather_s = given.gather_s == 0 ? kGather : given.gather_s,
      .stopped = stopped});
  run::PolicyTraits traits;
  traits.draws = given.draws != 0;
  traits.content = store::kCallersPolicy;
  if (const std::string said = text_of(given.content); !said.empty()) traits.content += ": " + said;
  options.own_policy = run::OwnPolicy{
      traits, [questions](const run::PolicyContext&) -> Result<std::unique_ptr<policy::Policy>> {
        return api::make_asking(questions);
      }};
  return {};
}

void tell(const run::RunProgress& progress, const vlaprobe_run_options& given,
          std::atomic<bool>& stop) {
  vlaprobe_progress told{};
  told.done = progress.done;
  told.skipped = progress.skipped;
  told.total = progress.total;
  if (const store::ResultRow* row = progress.row) {
    told.task = row->task.c_str();
    told.episode = row->episode;
    told.seed = row->seed;
    told.steps = row->steps;
    told.invalid = row->invalid ? row->invalid->c_str() : nullptr;
    for (const store::MetricValue& metric : row->metrics) {
      if (metric.name == "success" && !row->invalid) told.success = metric.value != 0 ? 1 : 0;
    }
  }
  if (given.progress(given.user, &told) != 0) stop = true;
}

}  // namespace

extern "C" {

int32_t vlaprobe_run(const vlaprobe_plan* plan, const vlaprobe_run_options* options, char** summary,
                     vlaprobe_error* error) {
  std::atomic<bool> stop = false;
  const int32_t code = call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{plan, "plan"}, {options, "options"}}));
    PROBE_ASSIGN(const vlaprobe_run_options given, api::read_options(options));
    PROBE_ASSIGN(run::RunOptions wanted, read(given, *plan->shared));
    if (plan->shared->only_used_suites && wanted.suite.empty())
      return api::usage("the text declares no suite: add one, or name one of a used file");
    wanted.stopped = [&] {
      if (given.stopped != nullptr && given.stopped(given.user) != 0) stop = true;
      return stop.load();
    };
    if (given.act != nullptr) PROBE_TRY(use_callback(given, wanted.stopped, wanted));
    if (given.progress != nullptr)
      wanted.progress = [&](const run::RunProgress& progress) { tell(progress, given, stop); };
    PROBE_ASSIGN(const run::RunSummary made, run::run(plan->shared->plan(), wanted));
    const std::string out = made.out.empty() ? wanted.out : made.out;
    Json reasons = Json::array();
    for (const auto& reason : made.not_attempted.reasons())
      reasons.push_back({{"reason", reason.text}, {"episodes", reason.episodes}});
    return give({{"out", out},
                 {"total", made.total},
                 {"done", made.done},
                 {"skipped", made.skipped},
                 {"invalid", made.invalid},
                 {"not_attempted", made.not_attempted.count()},
                 {"not_attempted_reasons", std::move(reasons)},
                 {"notes", made.notes},
                 {"until", made.until},
                 {"speed", made.done > 0 ? store::to_text(made.call) : ""}},
                summary);
  });
  if (code == VLAPROBE_OK || !stop) return code;
  return api::fail(error, VLAPROBE_STOPPED, "the run was stopped; the same call continues", {});
}

int32_t vlaprobe_results(const char* folder, char** json, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{folder, "folder"}, {json, "json"}}));
    PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(folder));
    PROBE_ASSIGN(const store::ProvenResults proven, store::read_proven_results(folder));
    Json told = {{"policy", record.identity.policy},
                 {"plan_root", record.identity.plan_root},
                 {"suite", record.suite},
                 {"refused", proven.refused}};
    if (!record.identity.until.empty()) told["until"] = record.identity.until;
    std::string text = told.dump();
    // Rows are text already, and can be more than a tree of ours holds.
    text.back() = ',';
    text += "\"rows\":" + store::results_to_json(proven.rows) + "}";
    return give_text(text, json);
  });
}

int32_t vlaprobe_why(const char* folder, const char* task, int32_t episode, int32_t seed,
                     const char* metric, char** json, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{folder, "folder"}, {task, "task"}, {json, "json"}}));
    const std::optional<int> asked = seed < 0 ? std::nullopt : std::optional<int>(seed);
    PROBE_ASSIGN(const rejudge::EpisodeWhy why,
                 rejudge::why(folder, task, episode, asked, text_of(metric)));
    return give(rejudge::to_json(why), json);
  });
}

int32_t vlaprobe_compare(const char* folder, const char* other, const char* const* metrics,
                         size_t metric_count, char** json, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{folder, "folder"}, {other, "other"}, {json, "json"}}));
    report::CompareFoldersOptions request;
    PROBE_ASSIGN(request.metrics, api::read_texts(metrics, metric_count, "metrics"));
    PROBE_ASSIGN(const report::ComparedFolders compared,
                 report::compare_folders(folder, other, request));
    Json notes = Json::array();
    for (const report::Note& note : compared.benchmark.notes) {
      if (note.level == "bad") notes.push_back(note.text);
    }
    return give({{"comparison", report::to_json(compared.benchmark, compared.comparison)},
                 {"text", report::to_text(compared.benchmark, compared.comparison)},
                 {"notes", notes}},
                json);
  });
}

int32_t vlaprobe_report(const char* const* folders, size_t count,
                        const vlaprobe_report_options* options, char** json,
                        vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{options, "options"}}));
    PROBE_ASSIGN(const vlaprobe_report_options given, api::read_options(options));
    if (count == 0 || given.out == nullptr)
      return api::usage("a report is of folders, and has a page to write: `out`");
    if (given.jobs < 0) return api::usage("traces are read by at least one thread");
    report::ReportRequest request;
    PROBE_ASSIGN(request.dirs, api::read_texts(folders, count, "folders"));
    request.out = given.out;
    request.title = text_of(given.title);
    request.floors = text_of(given.floors);
    request.traces = given.no_traces == 0;
    request.jobs = given.jobs;
    request.program = std::string("vlaprobe ") + vlaprobe_version();
    request.command = "vlaprobe report";
    for (const std::string& dir : request.dirs) request.command += " " + dir;
    request.command += " -o " + request.out;
    const std::string inputs[] = {request.floors};
    PROBE_TRY(assets::check_output(request.out, inputs));
    PROBE_ASSIGN(report::LoadedReport loaded, report::load_report(request));
    const std::string page = report::page_text(loaded, report::read_episodes(loaded, request));
    PROBE_TRY(write_file(request.out, std::as_bytes(std::span(page))));
    Json notes = Json::array();
    for (const report::Note& note : loaded.benchmark.notes) notes.push_back(note.text);
    return give({{"out", request.out},
                 {"policies", loaded.benchmark.policies.size()},
                 {"episodes", loaded.benchmark.episodes.size()},
                 {"notes", notes}},
                json);
  });
}

int32_t vlaprobe_replay(const char* folder, const char* task, int32_t episode, int32_t seed,
                        const vlaprobe_replay_options* options, char** json,
                        vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{folder, "folder"}, {task, "task"}}));
    PROBE_ASSIGN(const vlaprobe_replay_options given, api::read_options(options));
    run::ReplayOptions wanted;
    wanted.verify = given.no_verify == 0;
    wanted.video = text_of(given.video);
    wanted.png = text_of(given.png);
    wanted.png_step = given.png_step;
    wanted.camera = text_of(given.camera);
    wanted.assets = api::folders_of(given.assets);
    const bool writes = !wanted.video.empty() || !wanted.png.empty();
    const auto inputs =
        writes ? store::files_of_run(folder, wanted.assets) : std::vector<std::string>();
    for (const std::string& out : {wanted.video, wanted.png})
      PROBE_TRY(assets::check_output(out, inputs));
    const std::optional<int> asked = seed < 0 ? std::nullopt : std::optional<int>(seed);
    PROBE_ASSIGN(const run::ReplayReport report, run::replay(folder, task, episode, asked, wanted));
    return give({{"steps", report.steps},
                 {"seed", report.seed},
                 {"identical", wanted.verify ? Json(report.identical) : Json()},
                 {"difference", report.difference},
                 {"fingerprint_differences", report.fingerprint_differences}},
                json);
  });
}
}
