#include "tests/servers/python_server.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

extern char** environ;

namespace probe::test {

// Debian's own, which has the packages; another one may come first in PATH.
constexpr const char* kPython = "/usr/bin/python3";

PythonServer::PythonServer(const std::string& script, const std::vector<std::string>& arguments) {
  const std::string path = std::string(VLAPROBE_SOURCE_DIR) + "/tests/servers/" + script;
  std::vector<std::string> words{kPython, "-u", path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  int pipes[2];
  if (pipe(pipes) != 0) return;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipes[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, pipes[0]);
  if (posix_spawn(&process_, kPython, &actions, nullptr, argv.data(), environ) != 0) process_ = -1;
  posix_spawn_file_actions_destroy(&actions);
  close(pipes[1]);
  FILE* out = fdopen(pipes[0], "r");
  char port[16] = "";
  if (process_ > 0 && std::fscanf(out, "port %15s", port) == 1) port_ = port;
  std::fclose(out);
}

PythonServer::~PythonServer() { stop(); }

void PythonServer::stop(int signal) {
  if (process_ <= 0) return;
  kill(process_, signal);
  waitpid(process_, nullptr, 0);
  process_ = -1;
}

}  // namespace probe::test
