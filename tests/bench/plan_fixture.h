// What benchmarks run, compiled once: a task of the suite, and the same with a camera on the wrist.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"
#include "tests/bench/need.h"

namespace probe::bench {

// A plan, one of its tasks and what that needs.
struct Fixture {
  plan::Plan plan;
  std::string suite;
  std::uint32_t task = 0;
  std::shared_ptr<const stage::SharedAssets> assets;
};

// `assets`: the folder of meshes and what belongs to them; empty for ours.
inline Fixture make_fixture(const std::string& file, const std::string& suite,
                            std::string_view task, const std::string& assets = "") {
  const std::string files[] = {file};
  const std::string root = assets.empty() ? asset_root() : assets;
  Compilation compiled =
      need(build(files, {.asset_root = root,
                         .suite = "",
                         .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}}));
  Fixture out{need(plan::Plan::from_bytes(std::move(compiled.plan))), suite, 0, nullptr};
  out.task = out.plan.find_task(task).value();
  const std::uint32_t tasks[] = {out.task};
  out.assets = need(stage::SharedAssets::load(out.plan, root, tasks));
  return out;
}

// One camera of 640 x 480.
inline const Fixture& one_camera() {
  static const Fixture fixture = make_fixture(suite_path(), "intact", "carrot_on_plate");
  return fixture;
}

// A camera of 224 x 224 on the wrist in addition, with the arm in its picture.
inline const Fixture& two_cameras() {
  static const Fixture fixture =
      make_fixture(VLAPROBE_SOURCE_DIR "/examples/wrist_camera.probe", "eyes", "carrot_two_eyes");
  return fixture;
}

inline const plan::Plan& suite_plan() { return one_camera().plan; }
inline std::uint32_t bench_task() { return one_camera().task; }
inline std::shared_ptr<const stage::SharedAssets> suite_assets() { return one_camera().assets; }

}  // namespace probe::bench
