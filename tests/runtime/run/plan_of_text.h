// A plan made of a Probe text, with the project's own assets and library.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <string>
#include <utility>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {

inline plan::Plan plan_of_file(const std::string& file, const std::string& suite = "") {
  const std::string root = VLAPROBE_SOURCE_DIR;
  CompileOptions options;
  options.asset_root = root + "/assets";
  options.library_folders = {root + "/dsl", root};
  options.suite = suite;
  auto built = build(std::span<const std::string>(&file, 1), options);
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  REQUIRE_MESSAGE(built->ok, render_text(built->diagnostics, built->sources));
  auto made = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
  return std::move(made).value();
}

// The text's suite is called `mine`.
inline plan::Plan plan_of_text(const std::string& text) {
  const TemporaryFolder folder;
  const std::string file = folder / "mine.probe";
  std::ofstream(file) << text;
  return plan_of_file(file, "mine");
}

}  // namespace probe::run
