// The verbs that show what a file holds, through the program: promised keys, suggestions, files
// written whole or not at all, and a watched file that is edited.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::read_file;
using probe::test::Sandbox;
using probe::test::write_file;
namespace fs = std::filesystem;

namespace {

probe::Json parsed(const Outcome& outcome) {
  REQUIRE(outcome.exit == 0);
  auto json = probe::Json::parse(outcome.out);
  REQUIRE_FALSE(json.is_discarded());
  return json;
}

// `vlaprobe check --watch` in the background; ended when this goes.
class Watching {
 public:
  Watching(const Sandbox& box, const std::string& file) : said_(box / "said") {
    const std::string path = (box / file).string();
    const std::string assets = VLAPROBE_SOURCE_DIR "/assets";
    const std::string out = said_.string();
    pid_ = fork();
    if (pid_ != 0) return;
    const int to = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(to, STDERR_FILENO);
    execl(VLAPROBE_BINARY_DIR "/vlaprobe", "vlaprobe", "check", "--watch", path.c_str(), "--assets",
          assets.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  ~Watching() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Watching(const Watching&) = delete;
  Watching& operator=(const Watching&) = delete;

  // Whether it says `part` after what was said before, within some seconds.
  bool says(const std::string& part) {
    for (int i = 0; i < 400; ++i) {
      const std::string text = read_file(said_);
      if (const auto at = text.find(part, heard_); at != std::string::npos) {
        heard_ = at + part.size();
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    MESSAGE(read_file(said_));
    return false;
  }
  // The exit code after Ctrl-C, or -1 when it goes on.
  int interrupt() {
    kill(pid_, SIGINT);
    for (int i = 0; i < 200; ++i) {
      int status = 0;
      if (waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return -1;
  }

 private:
  fs::path said_;
  pid_t pid_ = -1;
  std::size_t heard_ = 0;
};

}  // namespace

TEST_CASE("list and show have the promised keys") {
  Sandbox box;
  const auto list = parsed(box.vlaprobe("list $SUITE --json"));
  REQUIRE(list.is_array());
  for (const char* key : {"task", "baseline", "axes", "categories", "prompt", "episodes"})
    CHECK(list[0].contains(key));
  const auto task = parsed(box.vlaprobe("show $SUITE carrot_on_plate --json"));
  for (const char* key : {"task", "baseline", "axes", "categories", "prompt", "episodes", "source",
                          "target", "distractors", "horizon", "metrics", "starts", "scene",
                          "camera", "light", "distances_m", "ids"})
    CHECK_MESSAGE(task.contains(key), key);
  REQUIRE(task["starts"].size() == 24);
  for (const char* key : {"object", "x_m", "y_m", "roll_deg", "pitch_deg", "yaw_deg"})
    CHECK(task["starts"][0][0].contains(key));
  CHECK(task["starts"][0][0]["object"] == "carrot");
}

TEST_CASE("questions are listed with how often they are asked, and why a task is not asked them") {
  Sandbox box;
  const std::string suite = VLAPROBE_SOURCE_DIR "/suite/questions.probe";
  const auto listed = parsed(box.vlaprobe("list " + suite + " --questions --json"));
  REQUIRE(listed.contains("families"));
  std::int64_t questions = 0, asked = 0;
  std::map<std::string, const probe::Json*> families;
  for (const probe::Json& family : listed["families"]) {
    for (const char* key : {"form", "moment", "text", "pixels"}) CHECK(family.contains(key));
    questions += family["questions"].get<std::int64_t>();
    asked += family["asked"].get<std::int64_t>();
    families[family["set"].text() + "." + family["name"].text()] = &family;
    // A task is asked, or left out for a reason.
    std::size_t tasks = family["tasks"].get<std::size_t>();
    for (const probe::Json& omitted : family["omitted"]) {
      CHECK(!omitted["reason"].text().empty());
      tasks += omitted["tasks"].size();
    }
    CHECK(tasks == 51);
  }
  CHECK(listed["questions"] == questions);
  CHECK(listed["asked"] == asked);
  REQUIRE(families.contains("understanding.source"));
  const probe::Json& source = *families["understanding.source"];
  CHECK(source["form"] == "choice");
  CHECK(source["moment"] == "at start");
  CHECK(source["questions"] == 51);
  CHECK(source["asked"] == 51 * 24);
  REQUIRE(families.contains("understanding.avoid"));
  const probe::Json& avoid = *families["understanding.avoid"];
  CHECK(avoid["omitted"][0]["reason"] == "the instruction tells of nothing to leave alone");

  const Outcome text = box.vlaprobe("list " + suite + " --questions");
  CHECK(text.exit == 0);
  CHECK(contains(text.out, "understanding.source"));
  CHECK(contains(text.out, "51 tasks, 51 questions, asked 1224 times"));
  CHECK(contains(text.out + text.err, "questions, asked " + std::to_string(asked) + " times"));
  const Outcome none = box.vlaprobe("list $SUITE --questions");
  CHECK(none.exit == 0);
  CHECK(contains(none.out + none.err, "0 questions, asked 0 times"));
}

TEST_CASE("the count is of tasks and episodes and agrees with the list") {
  Sandbox box;
  const auto list = parsed(box.vlaprobe("list $SUITE --json"));
  const auto count = parsed(box.vlaprobe("list $SUITE --count --json"));
  CHECK(count["tasks"] == list.size());
  CHECK(contains(box.vlaprobe("list $SUITE --count").out, " tasks, "));
}

TEST_CASE("an unknown task or suite suggests the nearest in every verb") {
  Sandbox box;
  for (const char* verb : {"show $SUITE carot_on_plate", "draw $SUITE carot_on_plate",
                           "diff $SUITE carrot_on_plate carot_on_plate"}) {
    const Outcome outcome = box.vlaprobe(verb);
    CHECK(outcome.exit == 1);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, "did you mean `carrot_on_plate`?"));
  }
  for (const char* verb : {"list", "coverage", "graph"}) {
    const Outcome outcome = box.vlaprobe(std::string(verb) + " $SUITE --suite intct");
    CHECK(outcome.exit == 1);
    CHECK(contains(outcome.err, "did you mean `intact`?"));
  }
}

TEST_CASE("a task that is only copied is said to be abstract") {
  Sandbox box;
  const Outcome outcome = box.vlaprobe("show $SUITE on_table");
  CHECK(outcome.exit == 1);
  CHECK(contains(outcome.err, "task `on_table` is abstract"));
}

TEST_CASE("two tasks and two plans are compared") {
  Sandbox box;
  const auto tasks =
      parsed(box.vlaprobe("diff $SUITE carrot_on_plate carrot_on_plate_lang_color --json"));
  CHECK(tasks["axes"] == probe::Json{"language.appearance"});
  CHECK(tasks["equal"]["starts"] == 24);
  REQUIRE(box.vlaprobe("build $SUITE -o x.plan").exit == 0);
  const auto plans = parsed(box.vlaprobe("diff x.plan $SUITE --json"));
  CHECK(plans["a"] == plans["b"]);
  CHECK(plans["changed"].empty());
  CHECK(box.vlaprobe("diff x.plan y.plan").exit == 2);
}

TEST_CASE("coverage and graph are there for people and for programs") {
  Sandbox box;
  CHECK(parsed(box.vlaprobe("coverage $SUITE --json"))["bases"].size() >= 1);
  CHECK(contains(box.vlaprobe("coverage $SUITE").out, "cells are empty"));
  CHECK(parsed(box.vlaprobe("graph $SUITE --json"))["edges"].size() >= 3);
  CHECK(box.vlaprobe("graph $SUITE").out.starts_with("digraph tasks {\n"));
}

TEST_CASE("a picture goes to stdout or, whole, into a file") {
  Sandbox box;
  const Outcome shown = box.vlaprobe("draw $SUITE carrot_on_plate");
  CHECK(shown.exit == 0);
  CHECK(shown.out.starts_with("<svg "));
  CHECK(box.vlaprobe("draw $SUITE carrot_on_plate -o starts.svg").exit == 0);
  CHECK(read_file(box / "starts.svg") == shown.out);
  const Outcome nowhere = box.vlaprobe("draw $SUITE carrot_on_plate -o none/starts.svg");
  CHECK(nowhere.exit == 2);
  CHECK(contains(nowhere.err, "none/starts.svg"));
}

TEST_CASE("the help of each verb fits a screen and has an example") {
  Sandbox box;
  for (const char* verb : {"list", "show", "diff", "coverage", "graph", "draw", "check", "rephrase",
                           "ask", "slurm-ask", "demos", "export"}) {
    const Outcome help = box.vlaprobe(std::string(verb) + " --help");
    CHECK(help.exit == 0);
    CHECK(std::count(help.out.begin(), help.out.end(), '\n') <= 24);
    CHECK(contains(help.out, "example: vlaprobe " + std::string(verb)));
  }
}

TEST_CASE("what the help of ask leaves out works, and has a page") {
  Sandbox box;
  const Outcome help = box.vlaprobe("ask --help");
  const std::string page = read_file(VLAPROBE_SOURCE_DIR "/runtime/ask/README.md");
  for (const char* option : {"--name", "--suite", "--retries", "--give-up-after", "--insecure",
                             "--if-changed", "--assets", "--std"}) {
    CHECK_MESSAGE(contains(help.out, option), option);
    CHECK_MESSAGE(contains(page, "`" + std::string(option)), option);
  }
  const Outcome wrong = box.vlaprobe("ask $SUITE --model truth -o answers --if-changed maybe");
  CHECK(wrong.exit == 1);
  CHECK(contains(wrong.err, "--if-changed"));
}

TEST_CASE("a watched suite is checked again when a file it uses changes or is replaced") {
  Sandbox box;
  for (const auto& entry : fs::directory_iterator(VLAPROBE_SOURCE_DIR "/suite"))
    fs::copy(entry.path(), box / entry.path().filename().string());
  write_file(box / "own.probe", "use \"intact.probe\"\nuse \"mine.probe\"\n");
  write_file(box / "mine.probe", "task mine like carrot_on_plate { horizon 70 steps }\n");
  Watching watching(box, "own.probe");
  REQUIRE(watching.says("no findings,"));
  REQUIRE(watching.says("watching; Ctrl-C ends"));

  write_file(box / "mine.probe", "task mine like carot_on_plate { horizon 70 steps }\n");
  CHECK(watching.says("did you mean `carrot_on_plate`?"));
  CHECK(watching.says("1 error,"));

  // As editors do: a new file in the place of the old one.
  write_file(box / "mine.probe.new", "task mine like carrot_on_plate { horizon 80 steps }\n");
  fs::rename(box / "mine.probe.new", box / "mine.probe");
  CHECK(watching.says("no findings,"));

  // A file that is not there yet is seen when it comes.
  fs::rename(box / "mine.probe", box / "away");
  CHECK(watching.says("mine.probe"));
  fs::rename(box / "away", box / "mine.probe");
  CHECK(watching.says("no findings,"));
  CHECK(watching.interrupt() == 0);
}
