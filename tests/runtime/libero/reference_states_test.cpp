// All 6,500 stored starts, held against what the benchmark's own program reads in them.
#include <doctest/doctest.h>
#include <zlib.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/libero/states.h"
#include "runtime/libero/suites.h"
#include "tests/runtime/libero/reference.h"

namespace probe::libero {
namespace {

std::string unzipped(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  REQUIRE(file != nullptr);
  std::string text, part(std::size_t{1} << 20, '\0');
  int count = 0;
  while ((count = gzread(file.get(), part.data(), static_cast<unsigned>(part.size()))) > 0)
    text.append(part, 0, static_cast<std::size_t>(count));
  return text;
}

// suite,task,init,name,kind,x,y,z,qw,qx,qy,qz
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

double number(std::string_view cell) {
  double value = std::nan("");
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

}  // namespace

TEST_CASE("6,500 starts: every pose and joint, in the order that is stored") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const auto tasks_text = read_file(test::reference() + "libero_tasks.json");
  const auto index_text = read_file(test::reference() + "libero_starts_index.json");
  REQUIRE(tasks_text.ok());
  REQUIRE(index_text.ok());
  const Json tasks = Json::parse(*tasks_text)["tasks"], index = Json::parse(*index_text);
  const std::string csv = unzipped(test::reference() + "libero_starts.csv.gz");
  std::string_view rest = csv;
  const auto next_line = [&] {
    const std::size_t end = rest.find('\n');
    REQUIRE(end != rest.npos);
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return line;
  };
  next_line();  // the header
  // What the table's nine digits leave of a number.
  double farthest = 0, turned = 0;
  std::size_t starts = 0, wrong = 0;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const Json& task = tasks[t];
    const std::string suite = task["suite"].text(), file = task["file"].text();
    CAPTURE(file);
    const std::string path = test::reference() + "bddl_files/" + suite + "/" + file;
    const auto bddl = read_file(path);
    REQUIRE(bddl.ok());
    const BddlProblem problem = read_bddl(*bddl, path).problem;
    JointsOf joints_of;
    for (const auto& [name, fixture] : task["fixtures"].items()) {
      auto& joints = joints_of[fixture["category"].text()];
      joints.clear();
      for (const Json& joint : fixture["joints"])
        joints.push_back(joint.text().substr(name.size() + 1));
    }
    const std::string stem = file.substr(0, file.size() - 5);
    const auto states =
        read_states(test::reference() + "init_files/" + suite + "/" + stem + ".pruned_init",
                    problem, joints_of);
    REQUIRE_MESSAGE(states.ok(), to_text(states.failure()));
    CHECK(states->starts.size() == 50);
    REQUIRE(index[t]["fixture_joints"].size() == states->joint_names.size());
    for (std::size_t j = 0; j < states->joint_names.size(); ++j) {
      const auto& [fixture, joint] = states->joint_names[j];
      CHECK(index[t]["fixture_joints"][j].text() == fixture + "_" + joint);
    }
    for (std::size_t i = 0; i < states->starts.size(); ++i, ++starts) {
      const StartState& start = states->starts[i];
      CHECK(start.time == 0);
      CHECK(start.fastest == 0);
      const auto next_row = [&](std::string_view name, std::string_view kind) {
        const std::vector<std::string_view> cells = cells_of(next_line());
        const bool fits = cells.size() == 12 && cells[0] == suite &&
                          cells[2] == std::to_string(i) && cells[3] == name && cells[4] == kind;
        wrong += fits ? 0 : 1;
        return cells;
      };
      const auto compare = [](double value, std::string_view cell, double& worst) {
        worst = std::max(worst, std::abs(value - number(cell)));
      };
      for (std::size_t k = 0; k < 7; ++k)
        compare(start.arm[k], next_row("robot0_joint" + std::to_string(k + 1), "joint")[5], turned);
      for (std::size_t k = 0; k < 2; ++k) {
        compare(start.fingers[k],
                next_row("gripper0_finger_joint" + std::to_string(k + 1), "joint")[5], turned);
      }
      for (std::size_t k = 0; k < problem.objects.size(); ++k) {
        const auto cells = next_row(problem.objects[k].name, "object");
        for (std::size_t c = 0; c < 3; ++c)
          compare(start.objects[k].position[c], cells[5 + c], farthest);
        for (std::size_t c = 0; c < 4; ++c)
          compare(start.objects[k].rotation[c], cells[8 + c], farthest);
      }
      for (std::size_t k = 0; k < states->joint_names.size(); ++k) {
        const auto& [fixture, joint] = states->joint_names[k];
        compare(start.joints[k], next_row(fixture + "_" + joint, "fixture_joint")[5], turned);
      }
    }
  }
  CHECK(starts == 6500);
  CHECK(wrong == 0);
  CHECK(rest.empty());
  CHECK(farthest <= 1e-9);
  CHECK(turned <= 1e-8);
  MESSAGE("poses within " << farthest << ", joints within " << turned);
}

}  // namespace probe::libero
