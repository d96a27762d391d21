#include "runtime/export/dataset/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "runtime/base/paths.h"
#include "runtime/export/dataset/finished_films.h"
#include "runtime/export/dataset/in_order.h"
#include "runtime/export/dataset/layout.h"
#include "runtime/export/dataset/lerobot.h"
#include "runtime/export/dataset/partial_folder.h"
#include "runtime/export/dataset/pictures.h"
#include "runtime/export/dataset/provenance.h"
#include "runtime/export/dataset/repeater.h"
#include "runtime/export/dataset/rlds.h"
#include "runtime/export/dataset/robomimic.h"
#include "runtime/export/dataset/source.h"
#include "runtime/export/dataset/wordings.h"
#include "runtime/plan/starts_hash.h"
#include "runtime/policy/scripted.h"
#include "runtime/robot/rotation.h"
#include "runtime/run/episode.h"
#include "runtime/run/workers.h"
#include "runtime/show/clip.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/fingerprint.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"

namespace probe::dataset {
namespace {

// Beyond the one that each thread is at, so that none waits for a slower one at once.
constexpr std::size_t kAhead = 4;

Status check_options(const DatasetOptions& options) {
  if ((options.width == 0) != (options.height == 0) || options.width < 0 || options.height < 0 ||
      options.width > 4096 || options.height > 4096)
    return Failure{Fault::kUsage, "a size is WIDTHxHEIGHT, 1 to 4096 each", "--size"};
  if (options.wordings < 1 || options.wordings > 1000)
    return Failure{Fault::kUsage, "1 to 1000 wordings a demonstration", "--wordings"};
  if (options.fps < 0 || options.fps > 1000)
    return Failure{Fault::kUsage, "1 to 1000 frames a second", "--fps"};
  return {};
}

// What a worker hands over: a demonstration, or why there is none.
struct Made {
  Demonstration demonstration;
  std::unique_ptr<Film> film;
  std::string refused;
  bool is_kept = false;  // by an export that was killed
};

// One thread's.
class Maker {
 public:
  Maker(const Source& source, std::shared_ptr<const stage::SharedAssets> assets, const Shape& shape,
        const Layout& layout, const FinishedFilms& finished, const Wordings* wordings,
        const DatasetOptions& options)
      : source_(source),
        repeater_(source.plan, std::move(assets)),
        shape_(shape),
        layout_(layout),
        finished_(finished),
        wordings_(wordings),
        options_(options) {}

  Result<Made> make(const store::ResultRow& row) {
    Made made;
    const auto trace = store::prove(source_.plan, row);
    if (!trace) {
      made.refused = store::to_text(store::key_of(row)) + " of `" + source_.dir +
                     "`: " + to_text(trace.failure());
      return made;
    }
    // The record is not among what the trace's hash vouches for.
    if (trace->header.live) {
      made.refused = store::to_text(store::key_of(row)) + " of `" + source_.dir +
                     "`: its world did not wait for its policy, and its run's record says it did";
      return made;
    }
    if (!trace->header.later.empty()) {
      made.refused = store::to_text(store::key_of(row)) + " of `" + source_.dir +
                     "`: its instruction changes in the course of the episode, and a "
                     "demonstration has one";
      return made;
    }
    Demonstration& demonstration = made.demonstration;
    demonstration.run = source_.dir;
    demonstration.row = row;
    demonstration.prompt = trace->header.prompt;
    demonstration.success = is_success(row);
    demonstration.wordings = {trace->header.prompt};
    if (source_.is_pushed) {
      std::vector<robot::Action> done;
      for (const store::TraceStep& step : trace->steps) done.push_back(step.action);
      demonstration.pushed =
          policy::pushed_steps(run::draw_seed(trace->header.seed, trace->header.episode_id), done);
    }
    if (wordings_ != nullptr) {
      const plan::TaskRecord& task = source_.plan.tasks()[*source_.plan.find_task(row.task)];
      demonstration.wordings = wordings_->draw(
          {row.task, trace->header.prompt, to_hex(plan::starts_hash(source_.plan, task))},
          options_.wordings, row.trace_sha256);
    }
    if (auto kept = finished_.find(row.trace_sha256, trace->steps.size())) {
      demonstration.steps = std::move(kept->steps);
      made.film = std::move(kept->film);
      made.is_kept = true;
      return made;
    }
    Finished finished;
    PROBE_ASSIGN(const auto film, layout_.film(trace->steps.size()));
    PROBE_TRY(repeater_.repeat(*trace, [&](auto frames, const auto& observation, std::size_t at) {
      finished.steps.push_back(step_of(observation, trace->steps[at].action));
      return in_shape(shape_, frames, [&](auto pictures) { return film->add(pictures); });
    }));
    PROBE_ASSIGN(finished.film, film->finish());
    PROBE_TRY(finished_.keep(row.trace_sha256, finished));
    demonstration.steps = std::move(finished.steps);
    made.film = std::move(finished.film);
    return made;
  }

 private:
  static Step step_of(const policy::Observation& observation, const robot::Action& action) {
    const policy::Proprioception& body = observation.proprioception;
    const Vec3 place = body.tcp_in_base.position, turn = robot::to_rpy(body.tcp_in_base.rotation);
    Step step;
    step.state = {place.x(), place.y(), place.z(), turn.x(), turn.y(), turn.z(), body.openness};
    step.joints = body.joints;
    step.action = action;
    return step;
  }

  const Source& source_;
  Repeater repeater_;
  const Shape& shape_;
  const Layout& layout_;
  const FinishedFilms& finished_;
  const Wordings* wordings_;
  const DatasetOptions& options_;
};

Result<std::unique_ptr<Layout>> open_layout(Format format, const std::string& dir,
                                            const Shape& shape, const DatasetOptions& options) {
  switch (format) {
    case Format::kLerobot:
      return lerobot::open_layout(dir, shape, options);
    case Format::kRobomimic:
      return robomimic::open_layout(dir, shape);
    case Format::kRlds:
      return rlds::open_layout(dir, shape, options);
  }
  return Failure{Fault::kInternal, "unknown format", dir};
}

// Everything that is written, in order.
class Writing {
 public:
  Writing(Layout& layout, Provenance& provenance, const DatasetOptions& options, std::size_t total,
          DatasetReport& report)
      : layout_(layout),
        provenance_(provenance),
        options_(options),
        total_(total),
        report_(report) {}

  Status take(Made made) {
    if (!made.refused.empty()) {
      report_.left_out.push_back(made.refused);
      report_.refused.push_back(made.refused);
    } else if (const auto refusal = layout_.refusal(made.demonstration)) {
      report_.left_out.push_back(store::to_text(store::key_of(made.demonstration.row)) + " of `" +
                                 made.demonstration.run + "`: " + *refusal);
    } else {
      PROBE_TRY(layout_.add(made.demonstration, std::move(made.film)));
      PROBE_TRY(provenance_.add(made.demonstration));
    }
    if (made.is_kept) ++report_.kept;
    ++done_;
    if (options_.progress) options_.progress(done_, total_);
    return {};
  }

 private:
  Layout& layout_;
  Provenance& provenance_;
  const DatasetOptions& options_;
  std::size_t total_, done_ = 0;
  DatasetReport& report_;
};

// Adapters catch what libraries throw; this is for what they missed, memory above all.
Result<Made> make_guarded(Maker& maker, const store::ResultRow& row) {
  try {
    return maker.make(row);
  } catch (const std::exception& error) {
    return Failure{Fault::kInternal, std::string("exception: ") + error.what(),
                   store::to_text(store::key_of(row))};
  }
}

Status write_run(const Source& source, const Shape& shape, const Layout& layout,
                 const FinishedFilms& finished, const Wordings* wordings,
                 const DatasetOptions& options, Writing& writing) {
  if (source.rows.empty()) return {};
  PROBE_ASSIGN(const AssetRoot root, store::find_run_assets(source.dir, options.assets));
  PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(source.plan, root, source.tasks));
  const std::size_t jobs = static_cast<std::size_t>(std::max(options.jobs, 1));
  InOrder<Made> order(jobs + kAhead, [&](Made made) { return writing.take(std::move(made)); });
  return run::run_jobs(source.rows.size(), options.jobs, [&]() -> Result<run::Worker> {
    const auto maker =
        std::make_shared<Maker>(source, assets, shape, layout, finished, wordings, options);
    return run::Worker([&, maker](std::size_t index) -> Status {
      if (!order.wait_for(index)) return {};
      auto made = make_guarded(*maker, source.rows[index]);
      if (made) return order.give(index, std::move(*made));
      order.stop();
      return made.failure();
    });
  });
}

// What steps and films of finished demonstrations depend on beside their trace: the format, the
// cameras and their sizes, the rate of videos, and the program with its libraries.
std::string making(Format format, const Shape& shape) {
  std::string text = fmt::format("1 {} {}", static_cast<int>(format), shape.fps);
  for (const CameraShape& camera : shape.cameras)
    text += fmt::format(" {} {} {} {}", camera.name, camera.width, camera.height,
                        fmt::join(camera.views, ","));
  return text + " " + store::to_json(store::take_fingerprint({})) + " " + show::video_library();
}

// What has no other words in the table keeps its own, and that is told.
std::vector<std::string> without_words(const std::vector<Source>& sources,
                                       const Wordings& wordings) {
  std::set<std::string> tasks, others;
  for (const Source& source : sources) {
    for (const std::uint32_t index : source.tasks) {
      const plan::TaskRecord& task = source.plan.tasks()[index];
      const std::string name(source.plan.text(task.name));
      const Wordings::Told told{name, std::string(source.plan.text(task.prompt)),
                                to_hex(plan::starts_hash(source.plan, task))};
      if (wordings.has_for_other_starts(told)) {
        others.insert("`" + name + "` of `" + source.dir + "`");
      } else if (!wordings.has(told)) {
        tasks.insert(name);
      }
    }
  }
  std::vector<std::string> sentences;
  for (const std::string& task : others)
    sentences.push_back("other words for the instruction of " + task +
                        ": those of the table are proved for other starts, so it keeps its own");
  for (const std::string& task : tasks)
    sentences.push_back("other words for the instruction of `" + task +
                        "`: the table of wordings has none, so it keeps its own");
  return sentences;
}

}  // namespace

Result<DatasetReport> export_dataset(const std::vector<std::string>& runs, const std::string& out,
                                     Format format, const DatasetOptions& options) {
  PROBE_TRY(check_options(options));
  DatasetReport report;
  std::vector<Source> sources;
  std::size_t total = 0;
  std::set<std::string> taken;
  for (auto dir = runs.begin(); dir != runs.end(); ++dir) {
    const auto before =
        std::find_if(runs.begin(), dir, [&](const auto& other) { return is_same(other, *dir); });
    if (before != dir)
      return Failure{Fault::kUsage, "is the run that was already named as `" + *before + "`", *dir};
    PROBE_ASSIGN(Source source, open_source(*dir, options, taken, report.left_out));
    total += source.rows.size();
    sources.push_back(std::move(source));
  }
  if (total == 0)
    return Failure{Fault::kUsage,
                   report.left_out.empty()
                       ? "no stored episode matches `" + options.tasks + "`"
                       : "nothing is left to export: " + report.left_out.front(),
                   runs.empty() ? "" : runs.front()};
  PROBE_ASSIGN(const Shape shape, shape_of(sources, options));
  std::optional<Wordings> wordings;
  if (!options.rephrase.empty()) {
    PROBE_ASSIGN(wordings, Wordings::read(options.rephrase));
    for (std::string& sentence : without_words(sources, *wordings))
      report.left_out.push_back(std::move(sentence));
  }
  PROBE_ASSIGN(PartialFolder folder, PartialFolder::create(out, making(format, shape)));
  PROBE_ASSIGN(const auto layout, open_layout(format, folder.path(), shape, options));
  const FinishedFilms finished(folder.finished(), *layout);
  PROBE_ASSIGN(auto provenance, Provenance::create(folder.path()));
  Writing writing(*layout, *provenance, options, total, report);
  for (const Source& source : sources) {
    PROBE_TRY(write_run(source, shape, *layout, finished, wordings ? &*wordings : nullptr, options,
                        writing));
  }
  PROBE_ASSIGN(const Contents contents, layout->finish());
  if (contents.episodes == 0)
    return Failure{Fault::kTrace, "nothing is left to export: " + report.left_out.front(), out};
  report.demonstrations = contents.demonstrations;
  report.episodes = contents.episodes;
  report.frames = contents.frames;
  PROBE_TRY(provenance->finish({sources, shape, options, wordings ? wordings->sha256() : ""},
                               contents, report.left_out));
  PROBE_TRY(folder.finish());
  return report;
}

}  // namespace probe::dataset
