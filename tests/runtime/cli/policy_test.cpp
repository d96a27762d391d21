// The verb `policy` as a user types it.
#include <doctest/doctest.h>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

namespace probe::test {

TEST_CASE("ready profiles are listed, and the one to copy is read back") {
  const Sandbox sandbox;
  const Outcome list = sandbox.vlaprobe("policy profiles");
  CHECK(list.exit == 0);
  CHECK(list.out.find("pi0_bridge ") != std::string::npos);
  CHECK(list.out.find("gr00t_bridge_as_published    gr00t ") != std::string::npos);
  const Outcome copy = sandbox.vlaprobe("policy profiles copy_me");
  REQUIRE(copy.exit == 0);
  write_file(sandbox / "mine.profile", copy.out);
  CHECK(sandbox.vlaprobe("policy profiles ./mine.profile").exit == 0);
  write_file(sandbox / "mine.profile", copy.out + "chunk.uze = 4\n");
  const Outcome slip = sandbox.vlaprobe("policy profiles ./mine.profile");
  CHECK(slip.exit == 1);
  CHECK(slip.err.find("did you mean `chunk.use`?") != std::string::npos);
}

TEST_CASE("a policy test of no server is an error, of an absent one a finding") {
  const Sandbox sandbox;
  const Outcome expert = sandbox.vlaprobe("policy test expert");
  CHECK(expert.exit == 1);
  CHECK(expert.err.find("`expert` is no server") != std::string::npos);
  const Outcome absent = sandbox.vlaprobe("policy test openpi://127.0.0.1:1 --json");
  CHECK(absent.exit == 2);
  const auto json = Json::parse(absent.out);
  CHECK(json["checks"][0]["name"] == "connection");
  CHECK(json["checks"][0]["verdict"] == "wrong");
}

TEST_CASE("who shows no certificate is refused with --insecure, and nothing is warned of") {
  const Sandbox sandbox;
  const std::string rest =
      " " VLAPROBE_SOURCE_DIR "/suite/intact.probe -o " + (sandbox / "a").string() + " --insecure ";
  for (const std::string& call :
       {"run" + rest + "--policy expert", "run" + rest + "--policy openpi://127.0.0.1:1",
        "sweep" + rest + "--policy 'openpi://127.0.0.1:{}' --checkpoints 1,2",
        "slurm" + rest + "--policy expert --array 2",
        std::string("policy test openpi://127.0.0.1:1 --insecure"), "ask" + rest + "--model truth",
        "ask" + rest + "--model 'openai://127.0.0.1:1?model=m'"}) {
    CAPTURE(call);
    const Outcome refused = sandbox.vlaprobe(call);
    CHECK(refused.exit == 1);
    CHECK(refused.err.find("shows no certificate that could be left unchecked") !=
          std::string::npos);
    CHECK(refused.err.find("WARNING") == std::string::npos);
  }
}

}  // namespace probe::test
