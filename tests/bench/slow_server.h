// A reference server in this process, for measuring: it takes a fixed time an answer, one after the
// other as a GPU does, and always answers with actions that stay still.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "runtime/servers/profile.h"
#include "runtime/wire/listener.h"

namespace probe::bench {

class SlowServer {
 public:
  SlowServer(servers::Protocol protocol, std::chrono::milliseconds answer_time);
  // For `run --policy`: its address, and how its answers are read.
  const std::string& policy() const { return policy_; }

 private:
  std::unique_ptr<wire::Listener> listener_;
  std::string policy_;
};

}  // namespace probe::bench
