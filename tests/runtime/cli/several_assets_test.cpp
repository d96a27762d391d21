// Models of one's own: folders named one behind another, and models that lie beside their text.
#include <doctest/doctest.h>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::read_file;
using probe::test::Sandbox;
using probe::test::write_file;

namespace fs = std::filesystem;

namespace {

const char* const kBlock =
    "v -2 -2 -2\nv 2 -2 -2\nv 2 2 -2\nv -2 2 -2\nv -2 -2 2\nv 2 -2 2\nv 2 2 2\nv -2 2 2\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\n"
    "f 4 1 5\nf 4 5 8\n";

const char* const kText =
    "use \"suite/intact.probe\"\n"
    "object my_block { mesh \"my_block\"; box (-2cm, -2cm, -2cm) .. (2cm, 2cm, 2cm); density 500kg/m3\n"
    "  friction 0.5; unseen; name \"my block\" }\n"
    "task mine like on_table { source my_block; target plate }\n"
    "suite own trained on bridge_v2 { tasks { mine }; seeds 1 }\n";

// The block packed into `root`/objects/my_block.
void pack(const Sandbox& box, const std::string& root) {
  write_file(box / "block.obj", kBlock);
  const Outcome packed = box.vlaprobe("assets pack block.obj --scale 0.01 -o '" + root + "/objects/my_block'");
  REQUIRE_MESSAGE(packed.exit == 0, packed.err);
}

// The plan of one folder that has everything.
std::string plan_of_one(const Sandbox& box) {
  const fs::path all = box / "all";
  fs::copy(VLAPROBE_SOURCE_DIR "/assets", all, fs::copy_options::recursive);
  pack(box, "all");
  write_file(box / "one/mine.probe", kText);
  const Outcome built = box.vlaprobe("build one/mine.probe --assets all -o one.plan");
  REQUIRE_MESSAGE(built.exit == 0, built.err);
  return read_file(box / "one.plan");
}

}  // namespace

TEST_CASE("every verb takes several folders of assets, and the plan is that of one folder with all") {
  Sandbox box;
  const std::string plan = plan_of_one(box);
  pack(box, "mine");
  write_file(box / "text/mine.probe", kText);
  const std::string several = " --assets mine --assets $ASSETS";
  REQUIRE(box.vlaprobe("build text/mine.probe -o two.plan" + several).exit == 0);
  CHECK(read_file(box / "two.plan") == plan);
  REQUIRE(box.vlaprobe("build text/mine.probe -o two.plan --assets $ASSETS --assets mine").exit == 0);
  CHECK(read_file(box / "two.plan") == plan);
  for (const char* verb :
       {"check text/mine.probe", "list text/mine.probe", "list text/mine.probe --count",
        "show text/mine.probe mine", "draw text/mine.probe mine -o top.svg",
        "draw text/mine.probe mine --phrases -o words.png", "audit text/mine.probe --suite own",
        "coverage text/mine.probe", "graph text/mine.probe", "dis text/mine.probe",
        "rephrase text/mine.probe --suite own -o words.jsonl", "preview text/mine.probe mine -o all.png",
        "preview two.plan mine --start 0 -o one.png", "draw two.plan mine -o top.svg",
        "diff text/mine.probe mine mine", "doctor",
        "run text/mine.probe --policy null --episodes 0-0 -o ran", "run two.plan --policy null --episodes 0-0 -o ran2",
        "replay ran mine 0 --verify", "sheet ran -o sheet.png",
        "demos text/mine.probe --per-start 1 --episodes 0-0 -o shown"}) {
    const Outcome outcome = box.vlaprobe(verb + several);
    CHECK_MESSAGE(outcome.exit == 0, verb, ": ", outcome.err);
  }
  // A run remembers where its files were; a folder that is gone is not in the way.
  CHECK(box.vlaprobe("replay ran mine 0 --verify").exit == 0);
  fs::rename(box / "mine", box / "moved");
  const Outcome gone = box.vlaprobe("replay ran mine 0 --verify");
  CHECK(gone.exit == 2);
  CHECK_MESSAGE(contains(gone.err, "objects/my_block"), gone.err);
  CHECK(box.vlaprobe("replay ran mine 0 --verify --assets moved --assets $ASSETS").exit == 0);
  const Outcome absent = box.vlaprobe("check text/mine.probe --assets $ASSETS --assets mine");
  CHECK(absent.exit == 2);
  CHECK_MESSAGE(contains(absent.err, "mine: the asset folder given by --assets is not there"), absent.err);
}

TEST_CASE("a folder that a run has recorded and that is gone takes no other with it") {
  Sandbox box;
  const std::string plan = plan_of_one(box);
  pack(box, "near");
  write_file(box / "near/mine.probe", kText);
  REQUIRE(box.run("ln -s " VLAPROBE_SOURCE_DIR "/assets own").exit == 0);
  const std::string program = "'" VLAPROBE_BINARY_DIR "/vlaprobe' ";
  REQUIRE(box.run("{ export VLAPROBE_ASSETS=own; " + program +
                  "run near/mine.probe --policy null --episodes 0-0 -o ran; }")
              .exit == 0);
  fs::remove(box / "own");
  const Outcome again = box.vlaprobe("replay ran mine 0 --verify");
  CHECK_MESSAGE(again.exit == 0, again.err);
}

TEST_CASE("models beside their text are found without a flag, in its folder or in `assets` there") {
  Sandbox box;
  const std::string plan = plan_of_one(box);
  int number = 0;
  for (const char* place : {"near", "near/assets", "od:d", "named/assets"}) {
    const std::string ran = "ran_" + std::to_string(++number);
    const std::string folder = fs::path(place).begin()->string();
    fs::remove_all(box / folder);
    pack(box, place);
    write_file(box / (folder + "/mine.probe"), kText);
    // Somebody else's manifest is none of ours.
    write_file(box / (folder + "/manifest.json"), "{\"manifest_version\": 3}");
    const Outcome built = box.vlaprobe("build '" + folder + "/mine.probe' -o near.plan");
    REQUIRE_MESSAGE(built.exit == 0, place, ": ", built.err);
    CHECK(read_file(box / "near.plan") == plan);
    for (const std::string& verb :
         {"check '" + folder + "/mine.probe'", "draw '" + folder + "/mine.probe' mine -o top.svg",
          "preview '" + folder + "/mine.probe' mine --start 0 -o one.png",
          "run '" + folder + "/mine.probe' --policy null --episodes 0-0 -o " + ran,
          "replay " + ran + " mine 0 --verify"}) {
      const Outcome outcome = box.vlaprobe(verb);
      CHECK_MESSAGE(outcome.exit == 0, verb, ": ", outcome.err);
    }
  }
  // A plan lies beside them, too; elsewhere it does not know of them.
  fs::copy(box / "near.plan", box / "named/near.plan");
  CHECK(box.vlaprobe("preview named/near.plan mine --start 0 -o one.png").exit == 0);
  CHECK(box.vlaprobe("preview near.plan mine --start 0 -o one.png").exit == 2);

  // Of a text that is used, and from its own folder.
  fs::remove_all(box / "near");
  pack(box, "lib");
  write_file(box / "lib/things.probe", kText);
  write_file(box / "user/user.probe", "use \"../lib/things.probe\"\n");
  CHECK(box.vlaprobe("build user/user.probe -o user.plan").exit == 0);
  CHECK(box.run("cd lib && '" VLAPROBE_BINARY_DIR "/vlaprobe' check things.probe").exit == 0);
  // What is named comes first: a thing that both have is the named one.
  pack(box, "other");
  write_file(box / "other/objects/my_block/visual.glb", "no mesh");
  const Outcome named = box.vlaprobe("check user/user.probe --assets other --assets $ASSETS");
  CHECK(named.exit == 1);
  CHECK_MESSAGE(contains(named.err, "objects/my_block/visual.glb"), named.err);
}

TEST_CASE("who names a folder of one model, or none, is told the words that name what is missing") {
  Sandbox box;
  pack(box, "my_models");
  write_file(box / "mine.probe", kText);
  const Outcome unnamed = box.vlaprobe("check mine.probe", "VLAPROBE_ASSETS=$ASSETS");
  CHECK(unnamed.exit == 1);
  CHECK_MESSAGE(contains(unnamed.err, "help: it is in `my_models`: `--assets my_models --assets " VLAPROBE_SOURCE_DIR "/assets`"),
                unnamed.err);
  const Outcome alone = box.vlaprobe("check mine.probe --assets my_models");
  CHECK(alone.exit == 1);
  CHECK_MESSAGE(contains(alone.err, "`--assets my_models --assets "), alone.err);
  // As a shell takes them.
  fs::rename(box / "my_models", box / "my models");
  const Outcome spaced = box.vlaprobe("check mine.probe", "VLAPROBE_ASSETS=$ASSETS");
  CHECK_MESSAGE(contains(spaced.err, "it is in `my models`: `--assets 'my models' --assets "), spaced.err);
  fs::rename(box / "my models", box / "my_models");
  // The folders of an environment stand as in PATH.
  CHECK(box.vlaprobe("check mine.probe", "VLAPROBE_ASSETS=my_models:$ASSETS").exit == 0);
}

TEST_CASE("a cluster's image has no models of this machine, and which they are is said") {
  Sandbox box;
  pack(box, "near");
  write_file(box / "near/mine.probe", kText);
  const Outcome refused =
      box.vlaprobe("k8s near/mine.probe --array 2 --policy null --image i --claim c -o out");
  CHECK(refused.exit == 1);
  CHECK_MESSAGE(contains(refused.err, "near/mine.probe: `objects/my_block` lies in `near` on this machine"),
                refused.err);
}

TEST_CASE("a dataset of several runs is checked with the models of each") {
  Sandbox box;
  for (const std::string name : {"red", "blue"}) {
    pack(box, name);
    fs::rename(box / (name + "/objects/my_block"), box / (name + "/objects/" + name));
    std::string text = kText;
    for (auto at = text.find("my_block"); at != text.npos; at = text.find("my_block")) text.replace(at, 8, name);
    write_file(box / (name + "/mine.probe"), text);
    const Outcome ran =
        box.vlaprobe("run " + name + "/mine.probe --policy null --episodes 0-0 -o ran_" + name);
    REQUIRE_MESSAGE(ran.exit == 0, ran.err);
  }
  // A picture of another size is drawn again.
  const Outcome made =
      box.vlaprobe("export ran_red ran_blue --format robomimic --size 32x24 -o data");
  REQUIRE_MESSAGE(made.exit == 0, made.err);
  const Outcome checked = box.vlaprobe("export --check data ran_red ran_blue");
  CHECK_MESSAGE(checked.exit == 0, checked.err);
  CHECK_MESSAGE(contains(checked.out, "2 demonstrations"), checked.out);
}
