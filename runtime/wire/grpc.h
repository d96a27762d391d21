// gRPC without generated code: calls of a server's methods with messages as bytes, over a
// connection that is not made again behind one's back. grpc.cpp and grpc_listener.cpp are the only
// files that include gRPC's headers, which are those of its core in C: they take a second to
// compile.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/listener.h"
#include "runtime/wire/lookup.h"
#include "runtime/wire/value.h"

namespace probe::wire {

// What is asked: one message, or several of a stream that the client sends.
struct GrpcCall {
  std::string method;  // "/package.Service/Method"
  std::vector<Bytes> messages;
};

// A call as one frame, for listeners and transcripts: the method, a line's end, and each message
// behind its size, four bytes with the lowest first.
Frame to_frame(const GrpcCall& call);
// Fails (kPolicy) on a frame that is none.
Result<GrpcCall> call_of(const Frame& frame);

struct GrpcOptions {
  Duration connect_timeout{10'000};
  std::size_t largest_message = std::size_t{64} << 20;  // bytes that are read of an answer at most
  Resolver resolver = {};                               // of the host's name; none: the system's
};

class GrpcChannel {
 public:
  // Fails (kPolicy) where nobody listens; what listens is met by call().
  static Result<std::unique_ptr<GrpcChannel>> connect(const Endpoint& server,
                                                      const GrpcOptions& options = {});
  ~GrpcChannel();

  // The answer's message. Fails (kPolicy) naming the server and what happened: no gRPC, no answer
  // in `timeout`, gone, more than the largest message; kAnswered where the server's own code failed
  // or has no such method. After a failure only the destructor is of use.
  Result<Bytes> call(const GrpcCall& call, Duration timeout);

  // A call in two parts: begin() sends all messages but the last, which end() sends, with the same
  // results as call(). What is begun and not ended is cancelled.
  class Begun;
  std::shared_ptr<Begun> begin(const GrpcCall& call, Duration timeout);
  Result<Bytes> end(const std::shared_ptr<Begun>& begun);
  // All messages are sent, and end() only waits for the answer.
  std::shared_ptr<Begun> start(const GrpcCall& call, Duration timeout);

  // Whether the last failure was the connection's: the server may have been started anew.
  bool is_lost() const { return is_lost_; }

 private:
  struct Parts;
  explicit GrpcChannel(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
  bool is_lost_ = false;
};

// As listen_grpc, for a speaker whose answer() may be called from several threads at a time.
Result<std::unique_ptr<Listener>> listen_grpc_at_once(const std::string& address,
                                                      const std::string& port, MakeSpeaker make);

}  // namespace probe::wire
