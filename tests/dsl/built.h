// One construct, one small source: the analysed model or the built plan of a text behind the small
// suite, and what it says in a form that fits one line of a test.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/define/axes.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "tests/compiler/small_suite.h"

namespace probe::test {

inline std::string number_text(double value) {
  const double rounded = std::round(value * 1e6) / 1e6 + 0.0;
  std::string text = std::to_string(rounded);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

// The text behind the small suite; no diagnostics at all.
inline std::unique_ptr<Analysis> clean(const std::string& more) {
  auto analysis = analyze_with_suite(more);
  CHECK_MESSAGE(analysis->codes() == "", analysis->said());
  return analysis;
}

// The same as a whole text of its own.
inline std::unique_ptr<Analysis> clean_alone(const std::string& text) {
  auto analysis = analyze_text(text);
  CHECK_MESSAGE(analysis->codes() == "", analysis->said());
  return analysis;
}

template <typename Table>
const auto& named(const Table& table, std::string_view name) {
  for (const auto& row : table) {
    if (row.name == name) return row;
  }
  REQUIRE_MESSAGE(false, "nothing is called ", std::string(name));
  return *table.begin();
}

// "red -10,-10@0 tray -10,10@90": centimetres and degrees of yaw.
inline std::string start_text(const Analysis& a, const sema::Start& start) {
  std::string text;
  for (const sema::Start::Placed& placed : start.placed) {
    const auto& q = placed.turn.rotation;
    const double yaw = 2 * std::atan2(q[3], q[0]) * 180 / 3.14159265358979323846;
    text += (text.empty() ? "" : " ") + a.model.objects[placed.object].name + " " +
            number_text(100 * placed.x) + "," + number_text(100 * placed.y) + "@" +
            number_text(yaw);
  }
  return text;
}

inline std::vector<std::string> starts_text(const Analysis& a, std::string_view task) {
  std::vector<std::string> text;
  for (const sema::Start& start : a.task(task).starts) text.push_back(start_text(a, start));
  return text;
}

// "language.action distractors"
inline std::string axes_text(const Analysis& a, std::string_view task) {
  std::string text;
  for (const plan::Axis axis : plan::axes_in(a.task(task).axes))
    text += (text.empty() ? "" : " ") + std::string(plan::axis_name(axis));
  return text;
}

inline std::string names_text(const Analysis& a, const std::vector<sema::TaskId>& tasks) {
  std::string text;
  for (const sema::TaskId id : tasks) text += (text.empty() ? "" : " ") + a.model.tasks[id].name;
  return text;
}

// A text of ours without what it uses, for what has no folder to use texts from.
inline std::string page_of(const std::string& path) {
  std::ifstream file(std::string(VLAPROBE_SOURCE_DIR) + "/" + path);
  REQUIRE_MESSAGE(file.good(), path);
  std::string page;
  for (std::string line; std::getline(file, line);)
    page += (line.starts_with("use ") ? "" : line) + "\n";
  return page;
}
// The library's pages of contacts and places.
inline std::string places() {
  return page_of("dsl/std/contact.probe") + page_of("dsl/std/place.probe");
}

// What is said when the text behind the small suite is built; "" for a plan.
inline std::string failed_build(const std::string& more) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_failed_" + std::to_string(getpid()) + ".probe");
  write_text(file, kSmallSuite + more);
  const std::string name = file.string();
  const auto built = build(std::span<const std::string>(&name, 1), {asset_root(), ""});
  std::filesystem::remove(file);
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  return built->ok ? std::string() : render_text(built->diagnostics, built->sources);
}

// The plan of a text behind the small suite, and what it is asked for by name.
class Built {
 public:
  explicit Built(const std::string& more, const std::string& suite = "") {
    const auto folder =
        std::filesystem::temp_directory_path() /
        ("probe_construct_" + std::to_string(getpid()) + "_" + std::to_string(counter()++));
    write_text(folder / "test.probe", kSmallSuite + more);
    const std::string file = (folder / "test.probe").string();
    auto built = build(std::span<const std::string>(&file, 1), {asset_root(), suite});
    std::filesystem::remove_all(folder);
    REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
    INFO(render_text(built->diagnostics, built->sources));
    REQUIRE(built->ok);
    auto plan = plan::Plan::from_bytes(std::move(built->plan));
    REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
    plan_ = std::make_unique<plan::Plan>(std::move(plan).value());
  }

  const plan::Plan& plan() const { return *plan_; }
  std::uint32_t index(std::string_view task) const {
    const auto found = plan_->find_task(task);
    REQUIRE_MESSAGE(found.has_value(), std::string(task));
    return *found;
  }
  const plan::TaskRecord& task(std::string_view name) const { return plan_->tasks()[index(name)]; }
  std::string prompt(std::string_view name) const {
    return std::string(plan_->text(task(name).prompt));
  }

 private:
  static int& counter() {
    static int next = 0;
    return next;
  }
  std::unique_ptr<plan::Plan> plan_;
};

}  // namespace probe::test
