// Each kind of bad input gives one clear message that names thing and place, the right exit code,
// and no partial file.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::read_file;
using probe::test::Sandbox;
using probe::test::write_file;
namespace fs = std::filesystem;

namespace {

// The suite's text in the sandbox with one replacement in one of its files.
void copy_suite(const Sandbox& box, const std::string& file, const std::string& from,
                const std::string& to) {
  for (const auto& entry : fs::directory_iterator(VLAPROBE_SOURCE_DIR "/suite")) {
    if (!entry.is_regular_file()) continue;
    std::string text = read_file(entry.path());
    if (entry.path().filename() == file) {
      const std::size_t at = text.find(from);
      REQUIRE_MESSAGE(at != std::string::npos, "the suite no longer says: ", from);
      text.replace(at, from.size(), to);
    }
    write_file(box / ("suite/" + entry.path().filename().string()), text);
  }
}

void copy_assets(const Sandbox& box) {
  fs::copy(VLAPROBE_SOURCE_DIR "/assets", box / "assets", fs::copy_options::recursive);
}

}  // namespace

TEST_CASE("a typo in a name is an error at its place with the nearest spelling") {
  Sandbox box;
  copy_suite(box, "intact.probe", "source carrot", "source carot");
  const Outcome outcome = box.vlaprobe("check suite/intact.probe");
  CHECK(outcome.exit == 1);
  CHECK(contains(outcome.err, "P0201"));
  CHECK(contains(outcome.err, "`carot`"));
  CHECK(contains(outcome.err, "did you mean `carrot`?"));
  CHECK(contains(outcome.err, "suite/intact.probe:"));
}

TEST_CASE("a missing unit is an error that says which dimension was wanted") {
  Sandbox box;
  copy_suite(box, "layouts.probe", "-16cm", "-16");
  const Outcome outcome = box.vlaprobe("build suite/intact.probe -o x.plan");
  CHECK(outcome.exit == 1);
  CHECK(contains(outcome.err, "P0302"));
  CHECK(contains(outcome.err, "expected a length, found a number"));
  CHECK_FALSE(fs::exists(box / "x.plan"));
}

TEST_CASE("diagnostics as JSON name file, line and column") {
  Sandbox box;
  copy_suite(box, "intact.probe", "source carrot", "source carot");
  const Outcome outcome = box.vlaprobe("check --json suite/intact.probe");
  CHECK(outcome.exit == 1);
  CHECK(contains(outcome.out, "\"code\": \"P0201\""));
  CHECK(contains(outcome.out, "\"line\""));
}

TEST_CASE("a plan with one flipped byte is refused before anything runs") {
  Sandbox box;
  REQUIRE(box.vlaprobe("build $SUITE -o x.plan").exit == 0);
  std::string bytes = read_file(box / "x.plan");
  bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 1);
  write_file(box / "x.plan", bytes);
  for (const char* verb : {"verify x.plan", "run x.plan --policy null -o out", "dis x.plan"}) {
    const Outcome outcome = box.vlaprobe(verb);
    CHECK(outcome.exit == 2);
    CHECK(contains(outcome.err, "x.plan"));
    CHECK(contains(outcome.err, "byte"));
  }
  CHECK_FALSE(fs::exists(box / "out"));
}

TEST_CASE("a rule that no run stops by is refused with the rules there are, and leaves nothing behind") {
  Sandbox box;
  for (const char* rule : {"width 0%", "width 100%", "width", "until it is good", "decided-against"}) {
    const Outcome outcome =
        box.vlaprobe("run $SUITE --policy null -o out --until \"" + std::string(rule) + "\"");
    CHECK(outcome.exit == 1);
    CHECK(contains(outcome.err, std::string("--until `") + rule + "`"));
    CHECK(contains(outcome.err, "\"width 10%\""));
  }
  const Outcome nowhere =
      box.vlaprobe("run $SUITE --policy null -o out --until \"decided-against nowhere\"");
  CHECK(nowhere.exit == 1);
  CHECK(contains(nowhere.err, "nowhere: no run here"));
  const Outcome shard =
      box.vlaprobe("run $SUITE --policy null -o out --shard 1/2 --until \"width 5% of all\"");
  CHECK(shard.exit == 1);
  CHECK(contains(shard.err, "one order of all episodes"));
  CHECK_FALSE(fs::exists(box / "out"));
}

TEST_CASE("a URDF without the named link is an error at the name") {
  Sandbox box;
  copy_suite(box, "stage.probe", "tcp ee_gripper_link", "tcp ee_griper_link");
  const Outcome outcome = box.vlaprobe("check suite/intact.probe --assets $ASSETS");
  CHECK(outcome.exit == 1);
  CHECK(contains(outcome.err, "ee_griper_link"));
  CHECK(contains(outcome.err, "suite/stage.probe:"));
}

TEST_CASE("a mesh that is not there is an error at the object that names it") {
  Sandbox box;
  copy_suite(box, "catalog.probe", "mesh \"carrot\"", "mesh \"no_such_carrot\"");
  const Outcome outcome = box.vlaprobe("check suite/intact.probe --assets $ASSETS");
  CHECK(outcome.exit == 1);
  CHECK(contains(outcome.err, "no_such_carrot"));
  CHECK(contains(outcome.err, "suite/catalog.probe:"));
}

TEST_CASE("a mesh that changed and kept its size is refused by every way to check") {
  Sandbox box;
  copy_assets(box);
  std::string bytes = read_file(box / "assets/objects/carrot/visual.glb");
  bytes.replace(0, 4, "none");
  write_file(box / "assets/objects/carrot/visual.glb", bytes);
  for (const char* const flag : {"", " --json"}) {
    const Outcome outcome = box.vlaprobe("check $SUITE --assets assets" + std::string(flag));
    CAPTURE(flag);
    CHECK(outcome.exit == 1);
    CHECK(contains(outcome.out + outcome.err, "is no binary glTF"));
  }
}

TEST_CASE("a mesh that vanished or changed after the plan was built stops the run") {
  Sandbox box;
  copy_assets(box);
  REQUIRE(box.vlaprobe("build $SUITE -o x.plan --assets assets").exit == 0);
  SUBCASE("gone") { fs::remove(box / "assets/objects/carrot/visual.glb"); }
  SUBCASE("changed") { write_file(box / "assets/objects/carrot/visual.glb", "glTF no more"); }
  const Outcome outcome = box.vlaprobe("run x.plan --policy null -o out --assets assets");
  CHECK(outcome.exit == 2);
  CHECK(contains(outcome.err, "objects/carrot/visual.glb"));
  CHECK_FALSE(fs::exists(box / "out/results.sqlite"));
}

TEST_CASE("an output folder that cannot be written is named and nothing is left") {
  Sandbox box;
  write_file(box / "file", "not a folder");
  const Outcome run = box.vlaprobe("run $SUITE --policy null -o file/out");
  CHECK(run.exit == 2);
  CHECK(contains(run.err, "file/out"));
  const Outcome build = box.vlaprobe("build $SUITE -o file/x.plan");
  CHECK(build.exit == 2);
  CHECK(contains(build.err, "file/x.plan"));
}

TEST_CASE(
    "a file that is not there is the outside's fault, an unknown verb, flag, policy or task the "
    "user's") {
  Sandbox box;
  const Outcome missing = box.vlaprobe("check none.probe");
  CHECK(missing.exit == 2);
  CHECK(contains(missing.err, "none.probe"));
  const Outcome verb = box.vlaprobe("chekc x");
  CHECK(verb.exit == 1);
  CHECK(contains(verb.err, "did you mean `check`?"));
  const Outcome flag = box.vlaprobe("run $SUITE --polcy expert -o out");
  CHECK(flag.exit == 1);
  CHECK(contains(flag.err, "did you mean `--policy`?"));
  const Outcome policy = box.vlaprobe("run $SUITE --policy exprt -o out");
  CHECK(policy.exit == 1);
  CHECK(contains(policy.err, "expert"));
  const Outcome task = box.vlaprobe("show $SUITE carrot_on_plat");
  CHECK(task.exit == 1);
  CHECK(contains(task.err, "did you mean `carrot_on_plate`?"));
  const Outcome range = box.vlaprobe("run $SUITE --policy null -o out --episodes 5-2");
  CHECK(range.exit == 1);
  CHECK(contains(range.err, "--episodes"));
  CHECK_FALSE(fs::exists(box / "out"));
}

TEST_CASE("a name that would repaint the terminal is shown without its escapes") {
  const Sandbox box;
  const std::string name =
      "a\x1b[2J\xe2\x80\xae"
      "b\r";
  for (const std::string& verb : {"check '" + name + ".probe'", "results '" + name + "'",
                                  "export '" + name + "' -o x.jsonl", "'" + name + "'"}) {
    const Outcome refused = box.vlaprobe(verb);
    CHECK(refused.exit != 0);
    CHECK(!refused.err.empty());
    CHECK(refused.err.find('\x1b') == std::string::npos);
    CHECK(refused.err.find('\r') == std::string::npos);
    CHECK(refused.err.find("\xe2\x80\xae") == std::string::npos);
  }
}

TEST_CASE(
    "a file that is larger than is read may be read, where the user says so before or behind the "
    "verb") {
  Sandbox box;
  write_file(box / "large.urdf", "no robot");
  fs::resize_file(box / "large.urdf", 17 << 20);
  const std::string pack = "assets pack large.urdf -o out";
  const Outcome refused = box.vlaprobe(pack);
  CHECK(refused.exit == 2);
  CHECK_MESSAGE(contains(refused.err,
                         "has more than the 16 MiB that are read; `vlaprobe --allow-large` allows "
                         "8 times as much"),
                refused.err);
  for (const std::string& line : {"--allow-large " + pack, pack + " --allow-large"}) {
    const Outcome read = box.vlaprobe(line);
    CHECK_MESSAGE(read.exit == 2, read.err);  // for what is in it
    CHECK_FALSE_MESSAGE(contains(read.err, "MiB"), read.err);
  }
  CHECK(box.vlaprobe("explain P0304 --allow-large").exit == 0);
  CHECK(contains(box.vlaprobe("explain P0304 --alow-large").err, "did you mean `--allow-large`?"));
  CHECK(contains(box.vlaprobe("--help").out, "--allow-large"));
}

TEST_CASE("results of a folder without a run say so") {
  Sandbox box;
  const Outcome outcome = box.vlaprobe("results nowhere");
  CHECK(outcome.exit == 2);
  CHECK(contains(outcome.err, "nowhere"));
}

TEST_CASE("data that cannot be written to standard output is an error of the outside") {
  if (!fs::exists("/dev/full")) {
    MESSAGE("SKIPPED: no /dev/full here");
    return;
  }
  Sandbox box;
  for (const char* verb : {"list $SUITE --json", "show $SUITE carrot_on_plate", "dis $SUITE"}) {
    // The sandbox redirects standard output behind these words; a subshell gets there first.
    const Outcome outcome =
        box.vlaprobe("--version >/dev/null; ( '" VLAPROBE_BINARY_DIR "/vlaprobe' " +
                     std::string(verb) + " >/dev/full )");
    CHECK_MESSAGE(outcome.exit == 2, verb);
    CHECK(contains(outcome.err, "standard output"));
  }
}
