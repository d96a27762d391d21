// The language server: messages in, messages out. Knows nothing of how they travel, so that a pipe
// and a socket can carry them alike.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::lsp {

struct ServerOptions {
  AssetRoot assets;     // empty: found by itself
  std::string library;  // the folder that holds std/; empty: found by itself
  // How long nothing is typed until the whole check begins.
  std::chrono::milliseconds pause{250};
};

class Server {
 public:
  // Called with one whole JSON-RPC message at a time, by any thread.
  using Send = std::function<void(std::string)>;

  // Fails (kAsset, kUsage) where a folder that was named is none.
  static Result<std::unique_ptr<Server>> start(const ServerOptions& options, Send send);
  virtual ~Server() = default;

  // One message, whatever its bytes are.
  virtual void receive(std::string_view message) = 0;
  // Bytes that were no message.
  virtual void receive_mistake(std::string_view what) = 0;
  // Nothing more waits to be read: says what is wrong with the texts as they are now.
  virtual void settle() = 0;
  // After `exit`: no more messages are wanted.
  virtual bool has_ended() const = 0;
  // Of the program: 0 when `shutdown` came before `exit`, else 1.
  virtual int exit_code() const = 0;
  // Waits until the whole check of every program is done or `limit` has passed; for tests.
  virtual bool wait_checked(std::chrono::milliseconds limit) = 0;
};

}  // namespace probe::lsp
