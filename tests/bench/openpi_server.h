// An openpi server in this process, for measuring: it takes a fixed time an answer, one after the
// other as a GPU does, and always answers with four actions that stay still.
#pragma once

#include <chrono>
#include <memory>
#include <string>

namespace probe::bench {

class OpenpiServer {
 public:
  explicit OpenpiServer(std::chrono::milliseconds answer_time);
  ~OpenpiServer();
  std::string policy() const;  // "openpi://127.0.0.1:PORT"

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace probe::bench
