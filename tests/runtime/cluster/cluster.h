// A Slurm of this machine for a test.
#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace probe::cluster {

// Lives as long as this object, and ends with this process however that ends.
class Cluster {
 public:
  explicit Cluster(const std::string& dir, int nodes = 1, int cpus = 4) {
    int in[2], out[2];
    REQUIRE(::pipe2(in, O_CLOEXEC) == 0);
    REQUIRE(::pipe2(out, O_CLOEXEC) == 0);
    const std::string script = VLAPROBE_SOURCE_DIR "/tests/servers/slurm_cluster.sh";
    const std::string words[] = {std::to_string(nodes), std::to_string(cpus)};
    process_ = ::fork();
    REQUIRE(process_ >= 0);
    if (process_ == 0) {
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      ::execl("/bin/bash", "bash", script.c_str(), dir.c_str(), words[0].c_str(), words[1].c_str(),
              nullptr);
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    input_ = in[1];
    for (char c = 0; ::read(out[0], &c, 1) == 1 && c != '\n';) said_.push_back(c);
    ::close(out[0]);
    ::setenv("SLURM_CONF", (dir + "/slurm.conf").c_str(), 1);
  }
  ~Cluster() {
    ::close(input_);
    ::waitpid(process_, nullptr, 0);
    ::unsetenv("SLURM_CONF");
  }
  bool ready() const { return said_ == "ready"; }
  const std::string& said() const { return said_; }

 private:
  pid_t process_ = -1;
  int input_ = -1;
  std::string said_;
};

}  // namespace probe::cluster
