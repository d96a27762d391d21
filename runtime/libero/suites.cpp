#include "runtime/libero/suites.h"

#include <algorithm>

namespace probe::libero {
namespace {

constexpr Suite kSuites[] = {
#define LIBERO_SUITE(folder, horizon, tasks) {#folder, horizon, tasks},
#include "runtime/libero/suites.def"
};

struct TaskRow {
  std::string_view folder, stem;
};
constexpr TaskRow kTasks[] = {
#define LIBERO_TASK(folder, file) {#folder, file},
#include "runtime/libero/suites.def"
};

// Where the words of an instruction begin: behind "..._SCENE10_" in a name that begins with a
// capital, as the benchmark's grab_language_from_filename has it.
std::size_t begin_of_words(std::string_view stem) {
  if (stem.empty() || stem[0] < 'A' || stem[0] > 'Z') return 0;
  const std::size_t scene = stem.find("SCENE");
  if (scene == stem.npos) return 0;
  const std::size_t end = stem.find('_', scene);
  return end == stem.npos ? stem.size() : end + 1;
}

}  // namespace

std::span<const Suite> suites() { return kSuites; }

TaskOrder order_tasks(const Suite& suite, const std::vector<std::string>& stems) {
  std::vector<std::string> sorted = stems;
  std::ranges::sort(sorted);
  TaskOrder order;
  std::size_t number = 0;
  for (const TaskRow& row : kTasks) {
    if (row.folder != suite.folder) continue;
    const bool is_there = std::ranges::binary_search(sorted, row.stem);
    (is_there ? order.stems : order.missing).emplace_back(row.stem);
    if (is_there) order.numbers.push_back(number);
    ++number;
  }
  if (number == 0) {
    for (; number < sorted.size(); ++number) order.numbers.push_back(number);
    order.stems = std::move(sorted);
    return order;
  }
  for (const std::string& stem : sorted) {
    if (std::ranges::find(order.stems, stem) == order.stems.end()) order.strange.push_back(stem);
  }
  return order;
}

std::string instruction_of(std::string_view stem) {
  std::string words(stem.substr(begin_of_words(stem)));
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string scene_of(std::string_view stem) {
  std::string scene(stem.substr(0, begin_of_words(stem)));
  if (!scene.empty()) scene.pop_back();
  for (char& c : scene) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return scene;
}

}  // namespace probe::libero
