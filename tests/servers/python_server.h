// A reference policy server of tests/servers in a Python process of its own; it dies with this
// object.
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace probe::test {

class PythonServer {
 public:
  // Runs tests/servers/`script` and waits for the line "port N" on its output.
  explicit PythonServer(const std::string& script, const std::vector<std::string>& arguments = {});
  ~PythonServer();
  PythonServer(const PythonServer&) = delete;
  PythonServer& operator=(const PythonServer&) = delete;

  const std::string& port() const { return port_; }  // empty: the server did not start
  void stop(int signal = SIGKILL);

 private:
  pid_t process_ = -1;
  std::string port_;
};

}  // namespace probe::test
