// Results of a policy behind vla-eval's, GR00T's and OpenVLA's protocols are those of the policy in
// process.
#include "tests/runtime/run/served.h"
#include "tests/servers/python_server.h"

namespace probe::run {
using namespace probe::store;
using namespace probe::servers;
namespace {

using test::PythonServer;

// Numbers as ours, pictures as rendered: nothing on the way may round.
constexpr const char* kOurs =
    "action.rotation=vector&action.gripper=signed&action.threshold=none&chunk.use=all";

std::string at(const PythonServer& server, const std::string& name, const std::string& options) {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's packages of .ci/packages.txt are installed");
  return name + "://127.0.0.1:" + server.port() + "?" + options;
}

}  // namespace

TEST_CASE("24 episodes over vla-eval, GR00T and OpenVLA are those in process, bit for bit") {
  ServedRun run(ServedRun::Pictures::kSmall);
  const std::string actions = "actions=" + run.actions_file();
  const std::string ours = kOurs, whole_picture = "&image=first -> video.image_0";
  {
    const PythonServer server("vlaeval_server.py", {actions});
    run.check_equal(at(server, "vlaeval", ours));
    for (const ResultRow& row : run.served()) CHECK(row.sent_image_sha256 == row.image_sha256);
  }
  // These servers cannot tell one connection from another: one world asks at a time.
  {
    const PythonServer server("gr00t_server.py", {"n1.6", actions, "chunk=16"});
    run.check_equal(at(server, "gr00t", ours + whole_picture), 1);
  }
  {
    const PythonServer server("openvla_server.py", {actions, "chunk=8"});
    run.check_equal(at(server, "openvla", ours + "&chunk.length=any&dialect=encoded"), 1);
  }
  // In BridgeData's convention, roll pitch yaw and the gripper from 0 to 1, numbers round.
  {
    const PythonServer server("gr00t_server.py", {"n1.5", actions, "chunk=16", "bridge=1"});
    run.check_alike(at(server, "gr00t",
                       "action.rotation=euler&chunk.use=all&action.threshold=none&dialect=n1.5" +
                           whole_picture),
                    1);
  }
}

}  // namespace probe::run
