// Conversations with a server as a text file: what a bug report can have with it, and what tests
// play back. A line each:
//   vlaprobe transcript 1
//   protocol openpi
//   connection                     the frames of one connection follow, in order
//   > bin 172 sha256 0f3a...       a question, left out but for its size and hash
//   > bin hex 82a5...              a question
//   < text hex 7265...             what the server said
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/servers.h"
#include "runtime/wire/listener.h"

namespace probe::servers {

struct Line {
  bool is_question = false;
  wire::Frame frame;  // without bytes where they were left out
  std::uint64_t size = 0;
  std::string sha256;  // hex
  bool operator==(const Line&) const = default;
};

struct Transcript {
  Protocol protocol = Protocol::kOpenpi;
  std::vector<std::vector<Line>> connections;
  bool operator==(const Transcript&) const = default;
};

// Questions carry instructions and pictures: `with_questions` writes them too.
std::string to_text(const Transcript& transcript, bool with_questions);
// Fails (kUsage, where = "where:line") on a line that is none.
Result<Transcript> parse_transcript(std::string_view text, std::string_view where);

Line line_of(bool is_question, wire::Frame frame);

// Asks the server the questions of `policy test` over a listener of its own and writes down both
// sides. A server that cannot be reached, or fails, is in the transcript as far as it got; fails as
// make_transport and the listener do.
Result<Transcript> record(const ServerChoice& choice);

// Plays the server's side: a WebSocket's connections are the transcript's, one after the other and
// again from the first; where one speaker is for all, the frames begin again after the last. A
// question that is not the recorded one is answered all the same, and told.
Result<std::unique_ptr<wire::Listener>> play(const Transcript& transcript,
                                             const std::string& address, const std::string& port,
                                             std::function<void(const std::string&)> tell = {});

}  // namespace probe::servers
