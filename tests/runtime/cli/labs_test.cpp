// What machines of labs are like: an installation that nobody may write, a home directory that takes
// nothing more, clocks that differ, disks that are lost, two users, another CPU, any letters in a path.
#include <doctest/doctest.h>
#include <unistd.h>

#include "tests/runtime/cli/program.h"

namespace probe::test {
namespace {

constexpr const char* kRun = " --tasks carrot_on_plate --policy null ";

// Rows without the places of their traces.
std::string rows_of(const Sandbox& box, const std::string& dir) {
  const Outcome said = box.vlaprobe("results " + dir + " --json");
  CHECK_MESSAGE(said.exit == 0, said.err);
  std::istringstream lines(said.out);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (!contains(line, "\"trace\"")) kept += line + "\n";
  }
  CHECK(contains(kept, "\"trace_sha256\""));
  return kept;
}

bool is_root(const char* why) {
  if (::geteuid() == 0) return true;
  MESSAGE("skipped: only root ", why);
  return false;
}

// A mount in the sandbox, gone with this object whatever happens in between.
class Mount {
 public:
  Mount(const Sandbox& box, const std::string& name, const std::string& how)
      : box_(box), name_(name) {
    REQUIRE(box.run("mkdir " + name).exit == 0);
    is_there_ = box.run(how).exit == 0;
  }
  // Also what came about by half: what the sandbox removes is its own then.
  ~Mount() { box_.run("while umount -l " + name_ + " 2>/dev/null; do :; done"); }
  Mount(const Mount&) = delete;
  Mount& operator=(const Mount&) = delete;
  bool is_there() const { return is_there_; }

 private:
  const Sandbox& box_;
  std::string name_;
  bool is_there_ = false;
};

TEST_CASE("a home directory over its quota costs time and nothing else") {
  if (!is_root("may mount a small disk")) return;
  const Sandbox box;
  const Mount home(box, "home", "mount -t tmpfs -o size=64k none home");
  if (!home.is_there()) {
    MESSAGE("skipped: no disk can be mounted here");
    return;
  }
  CHECK(box.run("dd if=/dev/zero of=home/full bs=4k count=64").exit != 0);  // more than there is
  const std::string unset = "unset VLAPROBE_CACHE XDG_CACHE_HOME; export HOME='" +
                            (box / "home").string() + "'; ";
  const std::string program = "'" VLAPROBE_BINARY_DIR "/vlaprobe' ";
  const auto call = [&](const std::string& words) {
    return box.run("{ " + unset + program + words + "; }");
  };
  for (const std::string& words :
       {std::string("check $SUITE"), "run $SUITE --episodes 0-1" + std::string(kRun) + "-o run",
        std::string("results run"), std::string("report run -o page.html"),
        std::string("why run carrot_on_plate 1"), std::string("preview $SUITE carrot_on_plate -o a.png")}) {
    const Outcome said = call(words);
    CHECK_MESSAGE(said.exit == 0, words << ": " << said.err);
  }
  // What is to be written there is refused by name.
  const Outcome refused = call("run $SUITE --episodes 0-1" + std::string(kRun) + "-o home/run");
  CHECK(refused.exit == 2);
  CHECK_MESSAGE(refused.err.find("home/run") != std::string::npos, refused.err);
  CHECK_MESSAGE(refused.err.find("full") != std::string::npos, refused.err);
}

TEST_CASE("clocks of nodes that differ by an hour change no row, and no proof is kept of what is to come") {
  const Sandbox box;
  for (const char* shard : {"1", "2"}) {
    const Outcome ran = box.vlaprobe("run $SUITE --episodes 0-5" + std::string(kRun) + "--shard " +
                                     shard + "/2 -o shards/" + shard);
    REQUIRE_MESSAGE(ran.exit == 0, ran.err);
  }
  REQUIRE(box.vlaprobe("run $SUITE --episodes 0-5" + std::string(kRun) + "-o single").exit == 0);
  box.run("find shards/1 -exec touch -h -d '+1 hour' {} +");
  box.run("find shards/2 -exec touch -h -d '-1 hour' {} +");
  const Outcome merged = box.vlaprobe("merge shards/1 shards/2 -o merged");
  REQUIRE_MESSAGE(merged.exit == 0, merged.err);
  CHECK(rows_of(box, "merged") == rows_of(box, "single"));
  CHECK(box.vlaprobe("results shards/1").exit == 0);
  const Outcome again = box.vlaprobe("run $SUITE --episodes 0-5" + std::string(kRun) +
                                     "--shard 1/2 -o shards/1");
  CHECK(again.exit == 0);
  CHECK_MESSAGE(again.err.find("0 run now") != std::string::npos, (again.err + again.out));
  CHECK(box.vlaprobe("results shards/1 --follow").out.find("done") != std::string::npos);
}

TEST_CASE("a node that loses its disk: the same calls run what is missing, and the merge has all") {
  const Sandbox box;
  const auto shard = [&](const std::string& which) {
    return box.vlaprobe("run $SUITE --episodes 0-5" + std::string(kRun) + "--shard " + which +
                        "/2 -o shards/" + which);
  };
  REQUIRE(shard("1").exit == 0);
  REQUIRE(shard("2").exit == 0);
  REQUIRE(box.vlaprobe("run $SUITE --episodes 0-5" + std::string(kRun) + "-o single").exit == 0);
  // One lost all, the other the traces of a few rows.
  box.run("rm -r shards/1 && rm shards/2/traces/carrot_on_plate/$(ls shards/2/traces/carrot_on_plate | head -n 1)");
  const Outcome early = box.vlaprobe("merge shards/1 shards/2 -o early");
  CHECK(early.exit != 0);
  CHECK_MESSAGE(early.err.find("shards/1") != std::string::npos, early.err);
  REQUIRE(shard("1").exit == 0);
  const Outcome again = shard("2");
  CHECK_MESSAGE((again.err + again.out).find("1 run now") != std::string::npos, (again.err + again.out));
  const Outcome merged = box.vlaprobe("merge shards/1 shards/2 -o merged");
  REQUIRE_MESSAGE(merged.exit == 0, merged.err);
  CHECK(rows_of(box, "merged") == rows_of(box, "single"));
}

TEST_CASE("two users of one folder: who may not write is told so and may read, of a group both write") {
  if (!is_root("may be others")) return;
  const Sandbox box;
  // Numbers without names are users, too.
  const auto as = [&](const char* user, const char* umask, const std::string& words) {
    return box.run("env HOME=/nonexistent setpriv --reuid=" + std::string(user) +
                   " --regid=47110 --clear-groups bash -c \"umask " + umask + "; '" VLAPROBE_BINARY_DIR
                   "/vlaprobe' " + words + "\"");
  };
  REQUIRE(box.run("chmod 755 . && mkdir lab && chgrp 47110 lab && chmod 2775 lab").exit == 0);
  if (as("47111", "022", "--help").exit != 0) {
    MESSAGE("skipped: others may not read the build's folder");
    return;
  }
  const std::string two = "run $SUITE --episodes 0-1" + std::string(kRun) + "-o lab/",
                    four = "run $SUITE --episodes 0-3" + std::string(kRun) + "-o lab/";
  REQUIRE(as("47111", "022", two + "own").exit == 0);
  const Outcome refused = as("47112", "022", four + "own");
  CHECK(refused.exit == 2);
  CHECK_MESSAGE(refused.err.find("lab/own: the folder cannot be written: Permission denied") !=
                    std::string::npos,
                refused.err);
  CHECK(as("47112", "022", "results lab/own").out.find("0 of 2") != std::string::npos);
  CHECK(as("47112", "022", "report lab/own -o lab/page.html").exit == 0);

  const Outcome first = as("47111", "002", two + "shared");
  REQUIRE_MESSAGE(first.exit == 0, first.err);
  const Outcome second = as("47112", "002", four + "shared");
  CHECK_MESSAGE(second.exit == 0, second.err);
  CHECK_MESSAGE((second.err + second.out).find("2 were there") != std::string::npos,
                (second.err + second.out));
  CHECK(as("47111", "002", "results lab/shared").out.find("0 of 4") != std::string::npos);
  // Both at once: one writes, the other is told.
  const Outcome both = as("47111", "002",
                          "run $SUITE --tasks 'carrot*' --policy null -o lab/both & sleep 2; '"
                          VLAPROBE_BINARY_DIR "/vlaprobe' results lab/both >/dev/null; wait %1");
  CHECK_MESSAGE(both.exit == 0, both.err);
}

TEST_CASE("a bundle for another CPU says so at its start") {
  const Sandbox box;
  // Of no processor but one that is not made any more.
  const Outcome made = box.run("cc -o launcher -DVLAPROBE_MARCH='\"avx5124fmaps\"' "
                               "-DVLAPROBE_LOADER='\"ld.so\"' '" VLAPROBE_SOURCE_DIR
                               "/runtime/cli/main/launcher.c'");
  REQUIRE_MESSAGE(made.exit == 0, made.err);
  const Outcome said = box.run("./launcher check x.probe");
#if defined(__x86_64__)
  CHECK(said.exit == 2);
  CHECK_MESSAGE(said.err.find("this CPU has not the instructions that the bundle was made for: "
                              "avx5124fmaps; build it here with") != std::string::npos,
                said.err);
#endif
}

TEST_CASE("a path may have blanks and any letters, from the text to the report") {
  const Sandbox box;
  const std::string place = "\"ein Ordner für 試, it's\"";
  REQUIRE(box.run("mkdir " + place).exit == 0);
  for (const std::string& words :
       {"build $SUITE -o " + place + "/'a plan.plan'",
        "run " + place + "/'a plan.plan' --episodes 0-1" + kRun + "-o " + place + "/'my run'",
        "results " + place + "/'my run'", "why " + place + "/'my run' carrot_on_plate 1",
        "report " + place + "/'my run' -o " + place + "/'the page.html'",
        "merge " + place + "/'my run' -o " + place + "/'merged too'",
        "gate " + place + "/'my run' --against " + place + "/'merged too' --junit " + place + "/'j u.xml'",
        "du " + place + "/'my run'", "gc " + place + "/'my run'",
        "results " + place + "/'my run' --follow"}) {
    const Outcome said = box.vlaprobe(words);
    CHECK_MESSAGE(said.exit == 0, words << ": " << said.err);
  }
}

TEST_CASE("an installation that nobody may write is all that is needed") {
  if (!is_root("may mount a folder for reading alone")) return;
  const Sandbox box;
  const Mount suite(box, "suite", "cp -r '" VLAPROBE_SOURCE_DIR
                                  "/suite' installed && mount --bind installed suite && "
                                  "mount -o remount,bind,ro suite");
  if (!suite.is_there()) {
    MESSAGE("skipped: no folder can be mounted here");
    return;
  }
  const Outcome ran = box.vlaprobe("run suite/intact.probe --episodes 0-1" + std::string(kRun) + "-o run");
  CHECK_MESSAGE(ran.exit == 0, ran.err);
  const Outcome refused = box.vlaprobe("build suite/intact.probe -o suite/intact.plan");
  CHECK(refused.exit == 2);
  CHECK_MESSAGE(refused.err.find("suite/intact.plan") != std::string::npos, refused.err);
}

}  // namespace
}  // namespace probe::test
