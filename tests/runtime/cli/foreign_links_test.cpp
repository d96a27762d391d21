// A run's folder that somebody sent, with links in it: going on with it writes inside of it alone.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/runtime/cli/program.h"

namespace probe::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFew = " \"$SUITE\" --tasks carrot_on_plate --policy null --jobs 1 ";

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::recursive_directory_iterator(folder), fs::recursive_directory_iterator()));
}

TEST_CASE("a run that goes on replaces links in its folder and leaves what they point to") {
  const Sandbox box;
  REQUIRE(box.vlaprobe(std::string("run") + kFew + "--episodes 0 -o good").exit == 0);
  write_file(box / "mine", "mine");
  for (const std::string name : {"suite.plan", "chosen", "videos/carrot_on_plate/1-42.mp4"}) {
    CAPTURE(name);
    fs::remove_all(box / "sent");
    fs::copy(box / "good", box / "sent", fs::copy_options::recursive);
    const fs::path link = box / ("sent/" + name);
    fs::create_directories(link.parent_path());
    fs::remove(link);
    fs::create_symlink(box / "mine", link);
    const Outcome ran =
        box.vlaprobe(std::string("run") + kFew + "--episodes 0-1 --seeds 42 --video all -o sent");
    CHECK_MESSAGE(ran.exit == 0, ran.err);
    CHECK(read_file(box / "mine") == "mine");
    CHECK(fs::is_regular_file(fs::symlink_status(link)));
  }
}

TEST_CASE("a run that goes on refuses folders and databases that are links") {
  const Sandbox box;
  REQUIRE(box.vlaprobe(std::string("run") + kFew + "--episodes 0 -o good").exit == 0);
  for (const std::string name :
       {"traces", "traces/carrot_on_plate", "videos", "videos/carrot_on_plate", "results.sqlite"}) {
    CAPTURE(name);
    for (const char* folder : {"sent", "outside"}) fs::remove_all(box / folder);
    fs::copy(box / "good", box / "sent", fs::copy_options::recursive);
    fs::create_directories(box / "outside");
    const fs::path link = box / ("sent/" + name);
    const fs::path there = box / "outside/it";
    if (fs::exists(link)) {
      fs::rename(link, there);
    } else {
      fs::create_directories(link.parent_path());
      fs::create_directories(there);
    }
    fs::create_symlink(there, link);
    const std::size_t before = entries(box / "outside");
    const std::string bytes = read_file(there);
    const Outcome ran =
        box.vlaprobe(std::string("run") + kFew + "--episodes 0-1 --seeds 42 --video all -o sent");
    CHECK(ran.exit == 2);
    CHECK(contains(ran.err, "is a link"));
    CHECK(entries(box / "outside") == before);
    CHECK(read_file(there) == bytes);
  }
}

TEST_CASE("merge, slurm and k8s write behind no link of the folder that they are given") {
  const Sandbox box;
  REQUIRE(box.vlaprobe(std::string("run") + kFew + "--episodes 0 -o good").exit == 0);
  write_file(box / "mine", "mine");
  fs::create_directories(box / "merged");
  fs::create_symlink(box / "mine", box / "merged/suite.plan");
  CHECK(box.vlaprobe("merge good -o merged").exit == 0);
  fs::create_directories(box / "array/slurm");
  fs::create_directories(box / "array/k8s");
  fs::create_symlink(box / "mine", box / "array/slurm/job.sh");
  fs::create_symlink(box / "mine", box / "array/k8s/job.yaml");
  const Outcome slurm = box.vlaprobe(std::string("slurm --array 2") + kFew + "-o array");
  CHECK(slurm.exit == 2);
  CHECK(contains(slurm.err, "array/slurm/job.sh: is a link"));
  const Outcome k8s =
      box.vlaprobe(std::string("k8s --array 2 --image i --claim c") + kFew + "-o array");
  CHECK_MESSAGE(k8s.exit == 0, k8s.err);
  CHECK(read_file(box / "mine") == "mine");
  fs::create_directories(box / "demo");
  fs::create_directory_symlink(box / "good", box / "demo/expert");
  const Outcome demo = box.vlaprobe("demo -o demo");
  CHECK(demo.exit == 2);
  CHECK(contains(demo.err, "demo/expert: is a link"));
}

TEST_CASE("the folder and the file that -o names may be links") {
  const Sandbox box;
  fs::create_directories(box / "disk");
  fs::create_symlink("disk", box / "run");
  CHECK(box.vlaprobe(std::string("run") + kFew + "--episodes 0 -o run").exit == 0);
  CHECK(fs::exists(box / "disk/results.sqlite"));
  fs::create_symlink("disk/page.html", box / "page.html");
  CHECK(box.vlaprobe("report run -o page.html").exit == 0);
  CHECK(fs::is_symlink(box / "page.html"));
  CHECK(fs::is_regular_file(box / "disk/page.html"));
}

}  // namespace
}  // namespace probe::test
