// What no -o may name.
#include "runtime/assets/output_file.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/plan/asset_files.h"
#include "tests/runtime/cli/program.h"

namespace probe::cli {
namespace {

namespace fs = std::filesystem;

std::string refusal(const fs::path& out, const std::vector<std::string>& inputs = {}) {
  const Status status = assets::check_output(out.string(), inputs);
  if (status.ok()) return "";
  CHECK(status.failure().code == Fault::kUsage);
  CHECK(status.failure().where == out.string());
  return status.failure().message;
}

TEST_CASE("a file that is read is not written over, by whatever name it is called") {
  const test::Sandbox box;
  test::write_file(box / "a.plan", "x");
  fs::create_symlink("a.plan", box / "link.plan");
  const std::vector<std::string> inputs = {(box / "a.plan").string()};
  const char* kRead = "is read by this command and is not written over; give -o another name";
  CHECK(refusal(box / "a.plan", inputs) == kRead);
  CHECK(refusal(box / "link.plan", inputs) == kRead);
  CHECK(refusal(box / "./a.plan", inputs) == kRead);
  CHECK(refusal(box / "b.plan", inputs).empty());
  CHECK(refusal(box / "no/such/folder/a.plan", inputs).empty());
}

TEST_CASE("Probe text that is there is not written over, a new file of that name is written") {
  const test::Sandbox box;
  test::write_file(box / "g.probe", "task a {}\n");
  CHECK(refusal(box / "g.probe") == "is Probe text and is not written over; give -o another name");
  CHECK(refusal(box / "new.probe").empty());
}

TEST_CASE("what a run is made of is not written over, also through links") {
  const test::Sandbox box;
  test::write_file(box / "run/results.sqlite", "x");
  test::write_file(box / "run/suite.plan", "x");
  test::write_file(box / "run/traces/carrot/0-0.trace", "x");
  fs::create_symlink("run/suite.plan", box / "plan.png");
  fs::create_symlink("run", box / "same");
  for (const char* out :
       {"run/results.sqlite", "run/results.sqlite-journal", "run/suite.plan", "run/lock",
        "run/traces/carrot/0-0.trace", "run/videos/x.mp4", "plan.png", "same/suite.plan"}) {
    CAPTURE(out);
    CHECK(refusal(box / out).starts_with("belongs to the run in `"));
  }
  for (const char* out : {"run/page.html", "run/carrot.png", "other.png", ""}) {
    CHECK(refusal(*out == 0 ? fs::path() : box / out).empty());
  }
}

TEST_CASE("what a folder of answers is made of is not written over") {
  const test::Sandbox box;
  test::write_file(box / "answers/answers.sqlite", "x");
  test::write_file(box / "answers/suite.plan", "x");
  for (const char* out : {"answers/answers.sqlite", "answers/answers.sqlite-wal",
                          "answers/suite.plan", "answers/lock"}) {
    CAPTURE(out);
    CHECK(refusal(box / out).starts_with("belongs to the answers in `"));
  }
  CHECK(refusal(box / "answers/report.html").empty());
}

TEST_CASE("what a search, an array and a sweep are made of is not written over") {
  const test::Sandbox box;
  test::write_file(box / "found/search.json", "{}");
  test::write_file(box / "found/rounds/001/points.csv", "x");
  test::write_file(box / "found/rounds/001/policy/results.sqlite", "x");
  test::write_file(box / "array/slurm/job.sh", "x");
  test::write_file(box / "sweep/sweep.json", "{}");
  for (const char* out : {"found/search.json", "found/rounds/001/points.csv",
                          "found/rounds/002/points.plan", "found/found.probe"}) {
    CAPTURE(out);
    CHECK(refusal(box / out).starts_with("belongs to the search in `"));
  }
  CHECK(refusal(box / "found/rounds/001/policy/suite.plan").starts_with("belongs to the run in `"));
  CHECK(refusal(box / "array/slurm/job").starts_with("belongs to the array in `"));
  CHECK(refusal(box / "sweep/sweep.json").starts_with("belongs to the sweep in `"));
  for (const char* out : {"found/page.html", "array/page.html", "sweep/page.html"}) {
    CHECK(refusal(box / out).empty());
  }
}

TEST_CASE("a transcript is written over by a transcript alone") {
  const test::Sandbox box;
  test::write_file(box / "server.txt", "vlaprobe transcript 1\nprotocol openpi\n");
  CHECK(refusal(box / "server.txt") ==
        "is a transcript and is not written over by anything else; give -o another name");
  CHECK(assets::check_output((box / "server.txt").string(), {}, assets::Writes::kTranscript).ok());
}

TEST_CASE("what assets are made of is not written over, also through links") {
  const test::Sandbox box;
  test::write_file(box / "own/cup.GLB", "x");
  test::write_file(box / "own/my.profile", "x");
  test::write_file(box / "assets/photo.png", "x");
  test::write_file(box / "assets/manifest.json",
                   R"({"files": [{"path": "photo.png", "bytes": 1, "sha256": "00"}]})");
  fs::create_symlink("assets/photo.png", box / "link.png");
  for (const char* out : {"own/cup.GLB", "own/my.profile"}) {
    CAPTURE(out);
    CHECK(refusal(box / out).starts_with("is no file that a verb writes"));
  }
  for (const char* out : {"assets/photo.png", "link.png", "assets/manifest.json"}) {
    CAPTURE(out);
    CHECK(refusal(box / out).starts_with("belongs to the assets in `"));
  }
  for (const char* out : {"assets/page.html", "own/new.glb", "own/picture.png"}) {
    CAPTURE(out);
    CHECK(refusal(box / out).empty());
  }
}

// The verbs themselves, with files that would be lost.
TEST_CASE("build and draw leave the text and the plan that they were given") {
  const test::Sandbox box;
  const test::Outcome built = box.vlaprobe("build \"$SUITE\" -o g.plan");
  REQUIRE_MESSAGE(built.exit == 0, built.err);
  const std::string plan = test::read_file(box / "g.plan");
  fs::copy_file(VLAPROBE_SOURCE_DIR "/examples/goal.probe", box / "g.probe");
  const std::string text = test::read_file(box / "g.probe");
  CHECK(box.vlaprobe("build g.probe -o g.probe").exit == 1);
  CHECK(test::read_file(box / "g.probe") == text);
  CHECK(box.vlaprobe("draw g.plan carrot_on_plate -o g.plan").exit == 1);
  CHECK(box.vlaprobe("preview g.plan carrot_on_plate -o g.plan").exit == 1);
  CHECK(test::read_file(box / "g.plan") == plan);
  fs::copy_file(box / "g.plan", box / "cited");
  CHECK(refusal(box / "cited") ==
        "is a plan and is not written over by anything else; give -o another name");
  CHECK(box.vlaprobe("draw g.probe carrot_on_plate -o cited").exit == 1);
  CHECK(test::read_file(box / "cited") == plan);
  CHECK(box.vlaprobe("build g.probe -o cited").exit == 0);
}

TEST_CASE("what is made of a text leaves the tables of starts that it reads") {
  const test::Sandbox box;
  fs::create_directories(box / "texts");
  fs::copy(VLAPROBE_SOURCE_DIR "/suite", box / "suite", fs::copy_options::recursive);
  for (const char* name : {"recorded_starts.probe", "recorded_starts.csv", "goal.probe"})
    fs::copy_file(std::string(VLAPROBE_SOURCE_DIR "/examples/") + name,
                  box / (std::string("texts/") + name));
  fs::create_symlink("texts/recorded_starts.csv", box / "link.csv");
  const std::string table = test::read_file(box / "texts/recorded_starts.csv");
  const std::string text = "texts/recorded_starts.probe", task = text + " carrot_as_recorded";
  for (const std::string& verb :
       {"build " + text, "draw " + task, "draw --phrases " + task, "preview " + task,
        "preview --start 0 " + task, "rephrase " + text,
        "rephrase texts/goal.probe --not-in " + text}) {
    for (const std::string out : {"texts/recorded_starts.csv", "link.csv"}) {
      CAPTURE(verb);
      CAPTURE(out);
      const test::Outcome outcome = box.vlaprobe(verb + " -o " + out);
      CHECK(outcome.exit == 1);
      CHECK(test::contains(outcome.err, "is read by this command and is not written over"));
      CHECK(test::read_file(box / "texts/recorded_starts.csv") == table);
    }
  }
}

TEST_CASE("pictures leave the textures that they are drawn from") {
  const test::Sandbox box;
  fs::copy(VLAPROBE_SOURCE_DIR "/assets", box / "own", fs::copy_options::recursive);
  fs::remove(box / "own/manifest.json");
  fs::copy(VLAPROBE_SOURCE_DIR "/suite", box / "suite", fs::copy_options::recursive);
  test::write_file(box / "g.probe",
                   "use \"suite/intact.probe\"\n"
                   "object wooden_plate like plate { texture \"wood\" 12cm }\n"
                   "task wooden like carrot_on_plate { target wooden_plate }\n"
                   "suite s trained on bridge_v2 { tasks { wooden }; seeds 42 }\n");
  const test::Outcome built = box.vlaprobe("build g.probe --suite s --assets own -o g.plan");
  REQUIRE_MESSAGE(built.exit == 0, built.err);
  const test::Outcome ran =
      box.vlaprobe("run g.plan --assets own --policy null --tasks wooden --episodes 0 -o run");
  REQUIRE_MESSAGE(ran.exit == 0, ran.err);
  int pictures = 0;
  const auto plan = plan::Plan::open((box / "g.plan").string());
  REQUIRE(plan.ok());
  for (const std::string& photo : plan::asset_files(*plan, (box / "own").string())) {
    if (!photo.ends_with(".png") && !photo.ends_with(".jpg")) continue;
    ++pictures;
    const std::string before = test::read_file(photo);
    for (const std::string verb :
         {"draw g.plan wooden --assets own -o ", "preview g.plan wooden --start 0 --assets own -o ",
          "sheet run -o ", "replay run wooden 0 --png ",
          "build g.probe --suite s --assets own -o "}) {
      CAPTURE(verb);
      CHECK(box.vlaprobe(verb + photo).exit == 1);
      CHECK(test::read_file(photo) == before);
    }
  }
  CHECK(pictures > 0);
}

TEST_CASE("a server's transcript leaves the certificate and the profile that it was asked with") {
  const test::Sandbox box;
  test::write_file(box / "ca.pem", "mine");
  const std::string profile = box.vlaprobe("policy profiles pi0_bridge_openpi").out;
  test::write_file(box / "own.txt", profile);
  for (const std::string out : {"ca.pem", "own.txt"}) {
    CAPTURE(out);
    const test::Outcome outcome =
        box.vlaprobe("policy record \"wss://localhost:1/?ca=ca.pem&profile=./own.txt\" -o " + out);
    CHECK(outcome.exit == 1);
    CHECK(test::contains(outcome.err, "is read by this command and is not written over"));
  }
  CHECK(test::read_file(box / "ca.pem") == "mine");
  CHECK(test::read_file(box / "own.txt") == profile);
}

TEST_CASE("a folder that holds a search is no folder of runs") {
  const test::Sandbox box;
  test::write_file(box / "found/search.json", "{}");
  const std::string few = "\"$SUITE\" --tasks carrot_on_plate --episodes 0 --policy null -o found";
  for (const std::string& verb :
       {"run " + few, "slurm --array 2 " + few, "k8s --array 2 --image i --claim c " + few}) {
    CAPTURE(verb);
    const test::Outcome outcome = box.vlaprobe(verb);
    CHECK(outcome.exit == 2);
    CHECK(test::contains(outcome.err, "holds a search; take another folder for a run"));
  }
  CHECK(std::distance(fs::directory_iterator(box / "found"), fs::directory_iterator()) == 1);
  const test::Outcome results = box.vlaprobe("results found");
  CHECK(test::contains(results.err, "holds a search, not a run"));
}

TEST_CASE("the program without the other verbs says so in the place of the one that has them") {
  const test::Sandbox box;
  fs::copy_file(VLAPROBE_BINARY_DIR "/vlaprobe", box / "vlaprobe");
  fs::copy_file(VLAPROBE_BINARY_DIR "/vlaprobe", box / "vlaprobe-full");
  const test::Outcome outcome = box.run("./vlaprobe doctor");
  CHECK(outcome.exit == 2);
  CHECK(test::contains(outcome.err, "is the program without the other verbs"));
}

TEST_CASE("a server's answers have a number of actions that a client takes") {
  const test::Sandbox box;
  for (const char* chunk : {"-1", "0", "100000000"}) {
    const test::Outcome outcome = box.vlaprobe(
        std::string("serve --policy digest --protocol openpi --port 0 --chunk ") + chunk);
    CHECK(outcome.exit == 1);
    CHECK(test::contains(outcome.err, "--chunk"));
  }
}

}  // namespace
}  // namespace probe::cli
