// A plan small enough to read: a carrot, a twig and a plate on the table of the first suite, one
// variant for each kind of change. Compiled in a folder of its own.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"

namespace probe::test {

inline std::string asset_root() { return VLAPROBE_SOURCE_DIR "/assets"; }

inline const char* const kTasks = R"(
use "catalog.probe"
use "stage.probe"
use "layouts.probe"
use "manipulation.probe"
use "language.probe"

object twig like carrot { color brown; name "twig" }
light evening { ambient 0.2 }

abstract task on_table { scene table; layout grid_24; metrics put_strict; say put; horizon 60 steps }
task base like on_table { source carrot; target plate }
variants of base {
  worded  { say drop_on }
  colored { say put_the; refer source as by_color; refer target as by_color }
  crowded { distractors twig }
  longer  { horizon 90 steps }
  dim     { light evening }
}
@allow(confounded, "published \"so\"")
variant both of crowded against base { say drop_on }
task other like on_table { source twig; target plate }

set looks = { dim, crowded }
suite all { tasks { base, worded, colored, crowded, longer, dim, both, other }; prefix "s_"; seeds 1 }
suite few { tasks { base, worded }; seeds 1 }
)";

// The plan of that text with `more` behind it and `from` replaced by `to`.
inline plan::Plan compile_small(const std::string& more = "", const std::string& from = "",
                                const std::string& to = "") {
  namespace fs = std::filesystem;
  std::string pattern = (fs::temp_directory_path() / "vlaprobe-inspect-XXXXXX").string();
  const fs::path folder = mkdtemp(pattern.data());
  for (const char* part : {"catalog", "stage", "layouts", "manipulation", "language"}) {
    const std::string name = std::string(part) + ".probe";
    fs::copy_file(VLAPROBE_SOURCE_DIR "/suite/" + name, folder / name);
  }
  std::string text = kTasks + more;
  if (!from.empty()) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  }
  std::ofstream(folder / "small.probe") << text;
  const std::string files[] = {(folder / "small.probe").string()};
  auto compiled = build(files, {.asset_root = asset_root(), .suite = ""});
  REQUIRE(compiled.ok());
  INFO(render_text(compiled->diagnostics, compiled->sources));
  REQUIRE(compiled->ok);
  fs::remove_all(folder);
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

inline const plan::Plan& small_plan() {
  static const plan::Plan plan = compile_small();
  return plan;
}

inline std::uint32_t task(const std::string& name) {
  const auto index = small_plan().find_task(name);
  REQUIRE(index.has_value());
  return *index;
}

}  // namespace probe::test
