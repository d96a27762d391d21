// What was released: task list and starts, read as data; and the suite of this tree, compiled once.
#pragma once

#include <doctest/doctest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::test {

// One object of one start.
struct PublishedPose {
  int episode = 0;
  std::string object;
  double x = 0, y = 0;                  // m
  double roll = 0, pitch = 0, yaw = 0;  // degrees
};

struct Published {
  Json tasks, objects;
  std::map<std::string, std::vector<PublishedPose>> starts;  // by task, in the file's order

  // The released entry of a task of ours.
  const Json* find(std::string_view task) const {
    for (const auto& entry : tasks) {
      if (entry["name"] == "widowx_" + std::string(task)) return &entry;
    }
    return nullptr;
  }
};

inline double decimal(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Nothing, and a message, where the released files are not on this machine.
inline const Published* published() {
  static const std::optional<Published> data = []() -> std::optional<Published> {
    const std::filesystem::path folder = VLAPROBE_SOURCE_DIR "/../shared/reference";
    const auto list = read_file((folder / "intact_tasks.json").string());
    std::ifstream starts(folder / "intact_starts.csv");
    if (!list || !starts) return std::nullopt;
    const Json file = Json::parse(*list);
    Published out{file["tasks"], file["objects"], {}};
    std::string line;
    std::getline(starts, line);  // the names of the columns
    while (std::getline(starts, line)) {
      std::vector<std::string> cells;
      std::istringstream parts(line);
      for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
      if (cells.size() != 8) continue;
      out.starts[cells[0]].push_back({static_cast<int>(decimal(cells[1])), cells[2],
                                      decimal(cells[3]), decimal(cells[4]), decimal(cells[5]),
                                      decimal(cells[6]), decimal(cells[7])});
    }
    return out;
  }();
  if (!data) MESSAGE("skipped: the released task list is not on this machine");
  return data ? &*data : nullptr;
}

inline plan::Plan compile_suite(const std::string& name) {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const std::string file = root + "/suite/" + name;
  auto built = build(std::span<const std::string>(&file, 1), {root + "/assets", ""});
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  REQUIRE_MESSAGE(built->ok, render_text(built->diagnostics, built->sources));
  auto opened = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE_MESSAGE(opened.ok(), to_text(opened.failure()));
  return std::move(opened).value();
}

inline const plan::Plan& suite_plan() {
  static const plan::Plan plan = compile_suite("intact.probe");
  return plan;
}

}  // namespace probe::test
