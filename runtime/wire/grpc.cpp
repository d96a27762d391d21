#include "runtime/wire/grpc.h"

#include <grpc/byte_buffer_reader.h>
#include <grpc/grpc.h>
#include <grpc/grpc_posix.h>
#include <grpc/grpc_security.h>
#include <grpc/support/alloc.h>
#include <grpc/support/log.h>
#include <grpc/support/time.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>

#include "runtime/base/printable.h"
#include "runtime/wire/grpc_bytes.h"
#include "runtime/wire/tcp_socket.h"

namespace probe::wire {
namespace {

constexpr std::size_t kLongestDetail = 300;

}  // namespace

namespace grpc_io {

// One call's own queue: of completions that this thread alone waits for.
struct Queue {
  grpc_completion_queue* queue = grpc_completion_queue_create_for_pluck(nullptr);
  Queue() = default;
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;
  ~Queue() {
    grpc_completion_queue_shutdown(queue);
    grpc_completion_queue_destroy(queue);
  }
  // Starts operations and waits for their end, which the call's deadline bounds.
  bool run(grpc_call* call, std::span<const grpc_op> ops) {
    void* tag = this;
    if (grpc_call_start_batch(call, ops.data(), ops.size(), tag, nullptr) != GRPC_CALL_OK)
      return false;
    return grpc_completion_queue_pluck(queue, tag, gpr_inf_future(GPR_CLOCK_REALTIME), nullptr)
               .success != 0;
  }
};

struct Outcome {
  grpc_status_code status = GRPC_STATUS_UNKNOWN;
  std::string details;
  std::optional<Bytes> message;
};

// One call from its first byte to its status.
class Exchange {
 public:
  Exchange(grpc_channel* channel, const std::string& method, Duration timeout) {
    const auto deadline = gpr_time_add(
        gpr_now(GPR_CLOCK_MONOTONIC),
        gpr_time_from_millis(static_cast<std::int64_t>(timeout.count()), GPR_TIMESPAN));
    call_ = grpc_channel_create_call(channel, nullptr, GRPC_PROPAGATE_DEFAULTS, queue_.queue,
                                     grpc_slice_from_copied_buffer(method.data(), method.size()),
                                     nullptr, deadline, nullptr);
    grpc_op begin{};
    begin.op = GRPC_OP_SEND_INITIAL_METADATA;
    is_sent_ = queue_.run(call_, {&begin, 1});
  }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;
  ~Exchange() {
    if (!is_over_) {
      grpc_call_cancel(call_, nullptr);
      end();
    }
    grpc_call_unref(call_);
  }

  // Nothing where the call is over already, of which end() has the status.
  void send(const Bytes& message) {
    if (!is_sent_) return;
    grpc_op send{};
    send.op = GRPC_OP_SEND_MESSAGE;
    send.data.send_message.send_message = grpc_buffer_of(message);
    is_sent_ = queue_.run(call_, {&send, 1});
    grpc_byte_buffer_destroy(send.data.send_message.send_message);
  }

  // Nothing more will be sent.
  void close() {
    if (!is_sent_ || is_closed_) return;
    grpc_op close{};
    close.op = GRPC_OP_SEND_CLOSE_FROM_CLIENT;
    is_sent_ = queue_.run(call_, {&close, 1});
    is_closed_ = true;
  }

  // The status comes whatever became of what was sent.
  Outcome end() {
    is_over_ = true;
    Outcome outcome;
    grpc_metadata_array first, last;
    grpc_metadata_array_init(&first);
    grpc_metadata_array_init(&last);
    grpc_slice details = grpc_empty_slice();
    grpc_byte_buffer* answer = nullptr;
    grpc_op ops[4]{};
    ops[0].op = GRPC_OP_RECV_INITIAL_METADATA;
    ops[0].data.recv_initial_metadata.recv_initial_metadata = &first;
    ops[1].op = GRPC_OP_RECV_MESSAGE;
    ops[1].data.recv_message.recv_message = &answer;
    ops[2].op = GRPC_OP_RECV_STATUS_ON_CLIENT;
    ops[2].data.recv_status_on_client = {&last, &outcome.status, &details, nullptr};
    ops[3].op = GRPC_OP_SEND_CLOSE_FROM_CLIENT;
    queue_.run(call_, {ops, std::size_t{is_sent_ && !is_closed_ ? 4U : 3U}});
    outcome.details.assign(reinterpret_cast<const char*>(GRPC_SLICE_START_PTR(details)),
                           GRPC_SLICE_LENGTH(details));
    if (answer != nullptr) {
      outcome.message = grpc_bytes_of(answer);
      grpc_byte_buffer_destroy(answer);
    }
    grpc_slice_unref(details);
    grpc_metadata_array_destroy(&first);
    grpc_metadata_array_destroy(&last);
    return outcome;
  }

 private:
  Queue queue_;
  grpc_call* call_ = nullptr;
  bool is_sent_ = false, is_closed_ = false, is_over_ = false;
};

}  // namespace grpc_io

grpc_byte_buffer* grpc_buffer_of(const Bytes& bytes) {
  grpc_slice slice =
      grpc_slice_from_copied_buffer(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  grpc_byte_buffer* buffer = grpc_raw_byte_buffer_create(&slice, 1);
  grpc_slice_unref(slice);
  return buffer;
}

Bytes grpc_bytes_of(grpc_byte_buffer* buffer) {
  Bytes bytes;
  grpc_byte_buffer_reader reader;
  if (grpc_byte_buffer_reader_init(&reader, buffer) == 0) return bytes;
  bytes.reserve(grpc_byte_buffer_length(buffer));
  grpc_slice slice;
  while (grpc_byte_buffer_reader_next(&reader, &slice) != 0) {
    bytes.insert(bytes.end(), GRPC_SLICE_START_PTR(slice), GRPC_SLICE_END_PTR(slice));
    grpc_slice_unref(slice);
  }
  grpc_byte_buffer_reader_destroy(&reader);
  return bytes;
}

void begin_grpc() {
  static const bool is_quiet = [] {
    // What it writes to standard error by itself is said in failures.
    gpr_set_log_function([](gpr_log_func_args*) {});
    grpc_init();
    return true;
  }();
  static_cast<void>(is_quiet);
}

struct GrpcChannel::Parts {
  std::string name;
  GrpcOptions options;
  grpc_channel* channel = nullptr;
  ~Parts() {
    if (channel != nullptr) grpc_channel_destroy(channel);
  }
};

GrpcChannel::GrpcChannel(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
GrpcChannel::~GrpcChannel() = default;

Result<std::unique_ptr<GrpcChannel>> GrpcChannel::connect(const Endpoint& server,
                                                          const GrpcOptions& options) {
  begin_grpc();
  PROBE_ASSIGN(const int socket, connect_socket(server, options.connect_timeout, options.resolver));
  auto parts = std::make_unique<Parts>();
  parts->name = server.name();
  parts->options = options;
  grpc_arg limit{};
  limit.type = GRPC_ARG_INTEGER;
  std::string key = GRPC_ARG_MAX_RECEIVE_MESSAGE_LENGTH;
  limit.key = key.data();
  limit.value.integer =
      static_cast<int>(std::min<std::size_t>(options.largest_message, std::size_t{1} << 30));
  const grpc_channel_args arguments{1, &limit};
  grpc_channel_credentials* open = grpc_insecure_credentials_create();
  parts->channel =
      grpc_channel_create_from_fd(server.authority().c_str(), socket, open, &arguments);
  grpc_channel_credentials_release(open);
  return std::unique_ptr<GrpcChannel>(new GrpcChannel(std::move(parts)));
}

class GrpcChannel::Begun {
 public:
  Begun(grpc_channel* channel, const GrpcCall& call, Duration timeout)
      : exchange(channel, call.method, timeout), method(call.method), stated(timeout) {}
  grpc_io::Exchange exchange;
  std::string method;
  Duration stated;
  std::optional<Bytes> last;
};

Result<Bytes> GrpcChannel::call(const GrpcCall& asked, Duration timeout) {
  return end(begin(asked, timeout));
}

std::shared_ptr<GrpcChannel::Begun> GrpcChannel::begin(const GrpcCall& asked, Duration timeout) {
  auto begun = std::make_shared<Begun>(parts_->channel, asked, timeout);
  for (std::size_t i = 0; i + 1 < asked.messages.size(); ++i)
    begun->exchange.send(asked.messages[i]);
  if (!asked.messages.empty()) begun->last = asked.messages.back();
  return begun;
}

std::shared_ptr<GrpcChannel::Begun> GrpcChannel::start(const GrpcCall& asked, Duration timeout) {
  auto begun = begin(asked, timeout);
  if (begun->last) begun->exchange.send(*begun->last);
  begun->last.reset();
  begun->exchange.close();
  return begun;
}

Result<Bytes> GrpcChannel::end(const std::shared_ptr<Begun>& begun) {
  if (begun->last) begun->exchange.send(*begun->last);
  grpc_io::Outcome outcome = begun->exchange.end();
  const auto failed = [&](Fault fault, std::string message) {
    return Failure{fault, std::move(message), parts_->name};
  };
  const std::string details = printable(outcome.details, kLongestDetail);
  switch (outcome.status) {
    case GRPC_STATUS_OK:
      if (outcome.message) return std::move(*outcome.message);
      return failed(Fault::kPolicy, "an answer without a message");
    case GRPC_STATUS_DEADLINE_EXCEEDED:
      return failed(Fault::kPolicy, "no answer in " + seconds_text(begun->stated));
    case GRPC_STATUS_RESOURCE_EXHAUSTED:
      if (details.find("larger than max") != std::string::npos) {
        return failed(Fault::kPolicy, "an answer of more than " +
                                          std::to_string(parts_->options.largest_message >> 20) +
                                          " MiB");
      }
      return failed(Fault::kAnswered, "the server is exhausted: " + details);
    case GRPC_STATUS_UNIMPLEMENTED:
      return failed(Fault::kAnswered, "a gRPC server that has no `" + begun->method + "`");
    case GRPC_STATUS_UNAVAILABLE:
      is_lost_ = true;
      if (details.find("http1") != std::string::npos || details.find("HTTP/1") != std::string::npos)
        return failed(Fault::kPolicy, "something listens there that does not speak gRPC");
      return failed(Fault::kPolicy, "the server went away");
    case GRPC_STATUS_UNKNOWN:
      if (details == "Stream removed") {  // what came was no HTTP/2
        is_lost_ = true;
        return failed(Fault::kPolicy, "something listens there that does not speak gRPC");
      }
      return failed(Fault::kAnswered, "the server failed: " + details);
    default:
      return failed(Fault::kPolicy, "the call failed (gRPC status " +
                                        std::to_string(static_cast<int>(outcome.status)) +
                                        "): " + details);
  }
}

Frame to_frame(const GrpcCall& call) {
  Frame frame;
  frame.bytes.assign(call.method.begin(), call.method.end());
  frame.bytes.push_back('\n');
  for (const Bytes& message : call.messages) {
    for (int shift = 0; shift < 32; shift += 8)
      frame.bytes.push_back(static_cast<std::uint8_t>(message.size() >> shift & 0xff));
    frame.bytes.insert(frame.bytes.end(), message.begin(), message.end());
  }
  return frame;
}

Result<GrpcCall> call_of(const Frame& frame) {
  const Failure none{Fault::kPolicy, "not a call of gRPC", ""};
  auto at = std::find(frame.bytes.begin(), frame.bytes.end(), std::uint8_t{'\n'});
  if (at == frame.bytes.end()) return none;
  GrpcCall call{{frame.bytes.begin(), at}, {}};
  for (++at; at != frame.bytes.end();) {
    if (frame.bytes.end() - at < 4) return none;
    std::size_t size = 0;
    for (std::ptrdiff_t i = 4; i-- > 0;) size = size << 8 | at[i];
    at += 4;
    if (static_cast<std::size_t>(frame.bytes.end() - at) < size) return none;
    const auto end = at + static_cast<std::ptrdiff_t>(size);
    call.messages.emplace_back(at, end);
    at = end;
  }
  return call;
}

}  // namespace probe::wire
