// Expanding a sweep to a million episodes and counting them: a text of a few dozen lines.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "compiler/emit/compile.h"
#include "tests/bench/need.h"

namespace {

using probe::bench::need;

// 21 lights, doubled eleven times, 24 episodes each: 1,032,216 with the suite itself.
std::string sweep_text() {
  std::string text = "use \"" + probe::bench::suite_path() + "\"\n";
  std::string lights;
  for (int i = 0; i < 21; ++i) {
    const std::string name = "level_" + std::to_string(i);
    text +=
        "light " + name + " { ambient 0." + std::to_string(10 + i) + "; sun (0, 0, -1) power 1 }\n";
    lights += "  at_" + name + " { light " + name + " }\n";
  }
  text +=
      "variants of carrot_on_plate {\n" + lights + "}\nset lit = variants of { carrot_on_plate }\n";
  std::string known = "lit where axis light";
  text += "set wave_0 = " + known + "\n";
  for (int i = 0; i < 11; ++i) {
    text += "derive \"{t}_h" + std::to_string(i) +
            "\" for t in wave_0 | derived where axis light or axis goal { horizon " +
            std::to_string(61 + i) + " steps }\n";
  }
  // What the lines above derive moves the goal alone.
  text +=
      "set derived = tasks where axis goal and not axis object.target and not axis distractors\n";
  return text;
}

void count_million(benchmark::State& state) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("probe_sweep_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << sweep_text();
  const std::string files[] = {file.string()};
  for (auto _ : state) {
    const probe::Counted counted =
        need(probe::count(files, {.asset_root = probe::bench::asset_root(), .suite = ""}));
    if (!counted.compilation.ok || counted.counts.episodes < 900'000)
      state.SkipWithError("the sweep does not expand");
    state.counters["tasks"] = static_cast<double>(counted.counts.tasks);
    state.counters["episodes"] = static_cast<double>(counted.counts.episodes);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
  std::filesystem::remove(file);
}
BENCHMARK(count_million)->Name("list/million")->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
