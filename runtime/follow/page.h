// A page on this machine that follows a run: what to_lines() says, drawn anew every two seconds.
// Read only; for whoever has its address, as the studio's.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/result.h"

namespace probe::follow {

class FollowPage {
 public:
  // Listens on 127.0.0.1 until it goes. `port` "0": any free one.
  static Result<std::unique_ptr<FollowPage>> start(const std::string& dir, const std::string& port);
  virtual ~FollowPage() = default;
  // With the token: "http://127.0.0.1:40123/1f9c.../".
  virtual std::string address() const = 0;
};

}  // namespace probe::follow
