// Loading: every mesh that is shipped, out of the mesh cache, and all that the suite's tasks need.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "runtime/scene/mesh_cache.h"
#include "tests/bench/plan_fixture.h"

namespace {

namespace fs = std::filesystem;
using probe::bench::need;

void load_catalogue(benchmark::State& state) {
  const fs::path folder = fs::temp_directory_path() / ("probe_bench_" + std::to_string(::getpid()));
  const probe::scene::MeshCache cache(folder.string());
  std::vector<std::string> meshes;
  for (const auto& entry : fs::recursive_directory_iterator(probe::bench::asset_root())) {
    if (entry.path().extension() == ".glb") meshes.push_back(entry.path().string());
  }
  for (const std::string& mesh : meshes) need(cache.load(mesh));  // fills it
  for (auto _ : state) {
    for (const std::string& mesh : meshes) benchmark::DoNotOptimize(need(cache.load(mesh)));
  }
  fs::remove_all(folder);
}
BENCHMARK(load_catalogue)->Name("assets/load_cached")->Unit(benchmark::kMillisecond);

// Meshes, collision shapes and robot of all tasks, files checked against the plan.
void load_suite(benchmark::State& state) {
  const probe::plan::Plan& plan = probe::bench::suite_plan();
  std::vector<std::uint32_t> tasks;
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) tasks.push_back(task);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        need(probe::stage::SharedAssets::load(plan, probe::bench::asset_root(), tasks)));
  }
}
BENCHMARK(load_suite)->Name("assets/load_suite")->Unit(benchmark::kMillisecond);

}  // namespace
