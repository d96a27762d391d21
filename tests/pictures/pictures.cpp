// What every camera of many tasks shows of an episode in which the arm moves, as a hash of colours,
// depths and ids, and how long a picture takes: two builds that should draw the same are compared
// by `diff`, and on one machine by their times.
//
//   pictures FILE.probe.. --assets DIR [--tasks GLOB] [--camera NAME] [--steps 30] [--rounds 1]
//
// The steps are played once; then their pictures are drawn `rounds` times. A row a camera: task,
// camera, hash of all pictures. With more rounds than one also the least time a picture took, ms of
// CPU, in the mean of the steps.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/compile/files.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/stage.h"

namespace probe {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string assets, tasks = "*", camera, steps = "30", rounds = "1";
};

// Where things were in a step.
struct Moment {
  std::vector<double> q;
  std::vector<Pose> objects;
};

Failure usage(const std::string& what) { return {Fault::kUsage, what, ""}; }

Result<Options> read_options(int count, char** words) {
  Options out;
  const std::map<std::string, std::string*> texts = {{"--assets", &out.assets},
                                                     {"--tasks", &out.tasks},
                                                     {"--camera", &out.camera},
                                                     {"--steps", &out.steps},
                                                     {"--rounds", &out.rounds}};
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (texts.contains(word)) {
      if (i + 1 >= count) return usage(word + " says nothing");
      *texts.at(word) = words[++i];
    } else if (word.starts_with("-")) {
      return usage("unknown option " + word);
    } else {
      out.files.push_back(word);
    }
  }
  if (out.files.empty()) return usage("no .probe file is named");
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(out.assets));
  out.assets = root.folders().front();
  return out;
}

// To and fro over the table, down and up again, with the hand closing and opening.
policy::Action motion(int step) {
  const double across = step / 8 % 2 == 0 ? 0.5 : -0.6, down = step / 12 % 2 == 0 ? -0.4 : 0.3;
  return {0.25, across, down, 0, 0.1, 0.2, step / 10 % 2 == 0 ? -1.0 : 1.0};
}

double cpu_ms() {
  timespec at{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at);
  return 1e3 * static_cast<double>(at.tv_sec) + 1e-6 * static_cast<double>(at.tv_nsec);
}

template <typename T>
std::span<const std::byte> bytes_of(std::span<const T> values) {
  return std::as_bytes(values);
}

Status draw_task(const plan::Plan& plan, std::uint32_t task, const Options& options) {
  const std::uint32_t tasks[] = {task};
  PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(plan, options.assets, tasks));
  PROBE_ASSIGN(const auto stage, stage::Stage::create(plan, task, assets));
  PROBE_TRY(stage->reset(0));
  std::vector<Moment> moments;
  const auto keep = [&] {
    moments.push_back({{stage->q().begin(), stage->q().end()},
                       {stage->objects().begin(), stage->objects().end()}});
  };
  keep();
  for (int step = 0; step < std::atoi(options.steps.c_str()); ++step) {
    PROBE_TRY(stage->step(motion(step)));
    keep();
  }
  const int rounds = std::max(1, std::atoi(options.rounds.c_str()));
  const auto views = plan.views(plan.tasks()[task]);
  for (std::size_t camera = 0; camera < views.size(); ++camera) {
    const std::string_view name = plan.text(views[camera].name);
    if (!options.camera.empty() && name != options.camera) continue;
    Hasher hasher;
    std::vector<double> least(moments.size(), std::numeric_limits<double>::infinity());
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < moments.size(); ++i) {
        const double begun = cpu_ms();
        PROBE_ASSIGN(const render::FrameView frame,
                     stage->view()->render(moments[i].q, moments[i].objects, camera));
        least[i] = std::min(least[i], cpu_ms() - begun);
        if (round > 0) continue;
        hasher.bytes(bytes_of(frame.rgb));
        hasher.bytes(bytes_of(frame.depth));
        hasher.bytes(bytes_of(frame.segmentation));
      }
    }
    double sum = 0;
    for (const double ms : least) sum += ms;
    fmt::print("{},{},{}", plan.text(plan.tasks()[task].name), name,
               to_hex(hasher.finish()).substr(0, 16));
    if (rounds > 1) fmt::print(",{:.3f}", sum / static_cast<double>(least.size()));
    fmt::print("\n");
  }
  return {};
}

Status draw_all(int count, char** words) {
  PROBE_ASSIGN(const Options options, read_options(count, words));
  for (const std::string& file : options.files) {
    PROBE_ASSIGN(Compilation made, compile::compile_files(
                                       {file}, {.assets = options.assets, .tasks = options.tasks}));
    if (!made.ok) return usage(file + " has errors: `vlaprobe check` says which");
    PROBE_ASSIGN(const plan::Plan plan, plan::Plan::from_bytes(std::move(made.plan)));
    for (std::uint32_t task = 0; task < plan.tasks().size(); ++task)
      PROBE_TRY(draw_task(plan, task, options));
  }
  return {};
}

}  // namespace
}  // namespace probe

int main(int count, char** words) {
  const probe::Status done = probe::draw_all(count, words);
  if (done.ok()) return 0;
  std::fputs((probe::to_text(done.failure()) + "\n").c_str(), stderr);
  return 2;
}
