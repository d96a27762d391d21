#include "runtime/lsp/stdio.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>

#include "runtime/lsp/frames.h"

namespace probe::lsp {
namespace {

// Whether something can be read at once.
bool is_waiting(int in) {
  pollfd poll_in{in, POLLIN, 0};
  return ::poll(&poll_in, 1, 0) > 0 && (poll_in.revents & POLLIN) != 0;
}

// All of it; false when nobody reads any more.
bool write_all(int out, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = ::write(out, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += static_cast<std::size_t>(written);
  }
  return true;
}

}  // namespace

Result<int> serve(int in, int out, const ServerOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);  // a closed output is an answer of write()
  std::mutex writing;
  std::atomic<bool> is_read = true;
  PROBE_ASSIGN(const std::unique_ptr<Server> server,
               Server::start(options, [&](std::string message) {
                 const std::lock_guard lock(writing);
                 if (is_read && !write_all(out, framed(message))) is_read = false;
               }));
  FrameReader frames;
  std::array<char, 65536> buffer;
  while (!server->has_ended() && is_read) {
    if (!is_waiting(in)) server->settle();
    const ssize_t size = ::read(in, buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0)
      return Failure{Fault::kIo, std::string("cannot be read: ") + std::strerror(errno),
                     "standard input"};
    if (size == 0) break;
    frames.add({buffer.data(), static_cast<std::size_t>(size)});
    while (!server->has_ended()) {
      const auto frame = frames.next();
      if (!frame) break;
      if (frame->mistake.empty()) {
        server->receive(frame->message);
      } else {
        server->receive_mistake(frame->mistake);
      }
    }
  }
  return server->exit_code();
}

}  // namespace probe::lsp
