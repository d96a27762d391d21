// Results of a policy behind openpi's protocol and its dialects are those of the policy in process.
#include "tests/runtime/run/served.h"

#include "tests/servers/python_server.h"

namespace probe::run {
using namespace probe::store;
namespace {

using test::PythonServer;

std::string at(const PythonServer& server, const std::string& name, const std::string& options) {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's python3-websockets is installed");
  return name + "://127.0.0.1:" + server.port() + options;
}

}  // namespace

TEST_CASE("24 episodes over openpi, INT-ACT and the shim are those in process, bit for bit") {
  ServedRun run;
  const std::string actions = "actions=" + run.actions_file();
  {
    const PythonServer server("openpi_server.py", {"openpi", "chunk=4", actions});
    run.check_equal(at(server, "openpi", ""));
    for (const ResultRow& row : run.served()) CHECK(row.sent_image_sha256 == row.image_sha256);
  }
  {
    const PythonServer server("openpi_server.py", {"intact", "chunk=4", actions});
    run.check_equal(at(server, "intact", "?model=/checkpoint&profile=pi0_bridge"));
  }
  {
    const PythonServer server("shim_server.py", {actions});
    run.check_equal(at(server, "openpi", "?profile=simpler_shim"));
  }
}

}  // namespace probe::run
