// A server for a browser: pages by GET, and WebSockets over which either side speaks whenever it
// wants. Knows nothing of what is said, nor of who may ask: `refuse` decides that.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "runtime/base/result.h"
#include "runtime/wire/listener.h"

namespace probe::wire {

// The head of a request; fields that it does not have are empty.
struct Visit {
  std::string method, target, host, origin;
  std::string site;  // Sec-Fetch-Site: what browsers say of where it comes from
  bool is_upgrade = false;
};

// Our mouth in one conversation, from any thread; once it is over nothing is said.
class Mouth {
 public:
  virtual ~Mouth() = default;
  virtual void say(Frame frame) = 0;
  // Bytes that were said and not taken by the other side yet: who makes pictures leaves some out.
  virtual std::size_t unread() const = 0;
  // Ends it with the reason, at most 120 bytes, behind what was said.
  virtual void end(const std::string& why) = 0;
};

// Our ear. Called by one thread.
class Ear {
 public:
  virtual ~Ear() = default;
  virtual void hear(const Frame& frame) = 0;
  // Nothing more waits to be heard.
  virtual void rest() {}
};

struct PageRules {
  // All three from several threads at once.
  // What somebody is told who may not ask; nothing: he may. Also of upgrades.
  std::function<std::optional<Page>(const Visit&)> refuse;
  std::function<Page(const Visit&)> page;
  // Null: there is nobody at this address to talk to.
  std::function<std::unique_ptr<Ear>(const Visit&, std::shared_ptr<Mouth>)> talk;
  std::size_t largest_message = std::size_t{32} << 20;  // bytes; a larger one ends the conversation
};

// `address` and `port` as of listen_websocket(). Ends every conversation when it goes.
Result<std::unique_ptr<Listener>> listen_pages(const std::string& address, const std::string& port,
                                               PageRules rules);

}  // namespace probe::wire
