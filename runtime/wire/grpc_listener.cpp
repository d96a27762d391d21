// gRPC servers' side: every call of whatever method is a frame, see grpc.h, and all have one
// speaker.
#include <grpc/grpc.h>
#include <grpc/grpc_security.h>
#include <grpc/support/time.h>

#include <array>
#include <charconv>
#include <list>
#include <mutex>
#include <span>
#include <thread>

#include "runtime/wire/grpc.h"
#include "runtime/wire/grpc_bytes.h"

namespace probe::wire {
namespace {

constexpr std::size_t kGrpcWorkers = 4;  // calls at a time, as LeRobot's server has them
constexpr int kLargestGrpcQuestion = 256 << 20;

// One call at a time, in a thread and a queue of its own.
class GrpcWorker {
 public:
  // `talk` is held while the speaker answers; null: it is not.
  GrpcWorker(grpc_server* server, grpc_completion_queue* queue, std::mutex* talk, Speaker& speaker)
      : server_(server), queue_(queue), talk_(talk), speaker_(speaker) {
    thread_ = std::thread([this] { work(); });
  }
  GrpcWorker(const GrpcWorker&) = delete;
  GrpcWorker& operator=(const GrpcWorker&) = delete;
  // After the server has been shut down.
  ~GrpcWorker() {
    thread_.join();
    grpc_completion_queue_shutdown(queue_);
    while (wait().type != GRPC_QUEUE_SHUTDOWN) {
    }
    grpc_completion_queue_destroy(queue_);
  }

 private:
  grpc_event wait() {
    return grpc_completion_queue_next(queue_, gpr_inf_future(GPR_CLOCK_REALTIME), nullptr);
  }
  bool run(grpc_call* call, std::span<const grpc_op> ops) {
    return grpc_call_start_batch(call, ops.data(), ops.size(), this, nullptr) == GRPC_CALL_OK &&
           wait().success != 0;
  }

  void work() {
    while (true) {
      grpc_call* call = nullptr;
      grpc_call_details details;
      grpc_call_details_init(&details);
      grpc_metadata_array metadata;
      grpc_metadata_array_init(&metadata);
      const bool is_asked = grpc_server_request_call(server_, &call, &details, &metadata, queue_,
                                                     queue_, this) == GRPC_CALL_OK &&
                            wait().success != 0;
      if (is_asked) {
        const auto* method = reinterpret_cast<const char*>(GRPC_SLICE_START_PTR(details.method));
        answer(call, {method, GRPC_SLICE_LENGTH(details.method)});
      }
      if (call != nullptr) grpc_call_unref(call);
      grpc_metadata_array_destroy(&metadata);
      grpc_call_details_destroy(&details);
      if (!is_asked) return;
    }
  }

  void answer(grpc_call* call, std::string method) {
    GrpcCall asked{std::move(method), {}};
    while (true) {
      grpc_byte_buffer* message = nullptr;
      grpc_op receive{};
      receive.op = GRPC_OP_RECV_MESSAGE;
      receive.data.recv_message.recv_message = &message;
      if (!run(call, {&receive, 1}) || message == nullptr) break;
      asked.messages.push_back(grpc_bytes_of(message));
      grpc_byte_buffer_destroy(message);
    }
    const Speaker::Reply reply = [&] {
      const auto lock =
          talk_ != nullptr ? std::unique_lock(*talk_) : std::unique_lock<std::mutex>();
      return speaker_.answer(to_frame(asked));
    }();
    Bytes bytes;
    for (const Frame& frame : reply.frames)
      bytes.insert(bytes.end(), frame.bytes.begin(), frame.bytes.end());
    grpc_byte_buffer* message = grpc_buffer_of(bytes);
    grpc_slice why =
        reply.close ? grpc_slice_from_copied_string(reply.close->c_str()) : grpc_empty_slice();
    int is_cancelled = 0;
    grpc_op ops[4]{};
    ops[0].op = GRPC_OP_SEND_INITIAL_METADATA;
    ops[1].op = GRPC_OP_SEND_STATUS_FROM_SERVER;
    ops[1].data.send_status_from_server.status = reply.close ? GRPC_STATUS_UNKNOWN : GRPC_STATUS_OK;
    ops[1].data.send_status_from_server.status_details = &why;
    ops[2].op = GRPC_OP_RECV_CLOSE_ON_SERVER;
    ops[2].data.recv_close_on_server.cancelled = &is_cancelled;
    ops[3].op = GRPC_OP_SEND_MESSAGE;
    ops[3].data.send_message.send_message = message;
    run(call, {ops, std::size_t{reply.close ? 3U : 4U}});
    grpc_slice_unref(why);
    grpc_byte_buffer_destroy(message);
  }

  grpc_server* server_;
  grpc_completion_queue* queue_;
  std::mutex* talk_;
  Speaker& speaker_;
  std::thread thread_;
};

class GrpcListener final : public Listener {
 public:
  GrpcListener(const MakeSpeaker& make, bool at_once) : speaker_(make()), at_once_(at_once) {}
  ~GrpcListener() override {
    if (server_ == nullptr) return;
    grpc_completion_queue* end = grpc_completion_queue_create_for_pluck(nullptr);
    grpc_server_shutdown_and_notify(server_, end, this);
    grpc_server_cancel_all_calls(server_);
    grpc_completion_queue_pluck(end, this, gpr_inf_future(GPR_CLOCK_REALTIME), nullptr);
    workers_.clear();
    grpc_server_destroy(server_);
    grpc_completion_queue_shutdown(end);
    grpc_completion_queue_destroy(end);
  }

  Status listen(const std::string& address, const std::string& port) {
    int number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error != std::errc() || end != port.data() + port.size() || number < 0 || number > 65535)
      return Failure{Fault::kUsage, "`" + port + "` is no port from 0 to 65535", address};
    begin_grpc();
    std::string keys[] = {GRPC_ARG_MAX_RECEIVE_MESSAGE_LENGTH, GRPC_ARG_ALLOW_REUSEPORT};
    grpc_arg settings[2]{};
    for (std::size_t i = 0; i < 2; ++i) {
      settings[i].type = GRPC_ARG_INTEGER;
      settings[i].key = keys[i].data();
      settings[i].value.integer = i == 0 ? kLargestGrpcQuestion : 0;
    }
    const grpc_channel_args arguments{2, settings};
    server_ = grpc_server_create(&arguments, nullptr);
    std::array<grpc_completion_queue*, kGrpcWorkers> queues{};
    for (grpc_completion_queue*& queue : queues) {
      queue = grpc_completion_queue_create_for_next(nullptr);
      grpc_server_register_completion_queue(server_, queue, nullptr);
    }
    const std::string host = address.find(':') == std::string::npos ? address : "[" + address + "]";
    grpc_server_credentials* open = grpc_insecure_server_credentials_create();
    const int bound = grpc_server_add_http2_port(server_, (host + ":" + port).c_str(), open);
    grpc_server_credentials_release(open);
    grpc_server_start(server_);
    for (grpc_completion_queue* queue : queues)
      workers_.emplace_back(server_, queue, at_once_ ? nullptr : &talk_, *speaker_);
    if (bound == 0)
      return Failure{Fault::kUsage, "listening: the address is not to be had, or taken",
                     address + ":" + port};
    port_ = std::to_string(bound);
    return {};
  }

  std::string port() const override { return port_; }

 private:
  std::mutex talk_;  // the speaker
  std::unique_ptr<Speaker> speaker_;
  bool at_once_;
  grpc_server* server_ = nullptr;
  std::list<GrpcWorker> workers_;
  std::string port_;
};

Result<std::unique_ptr<Listener>> listening(const std::string& address, const std::string& port,
                                            const MakeSpeaker& make, bool at_once) {
  auto listener = std::make_unique<GrpcListener>(make, at_once);
  PROBE_TRY(listener->listen(address, port));
  return std::unique_ptr<Listener>(std::move(listener));
}

}  // namespace

Result<std::unique_ptr<Listener>> listen_grpc(const std::string& address, const std::string& port,
                                              MakeSpeaker make) {
  return listening(address, port, make, false);
}

Result<std::unique_ptr<Listener>> listen_grpc_at_once(const std::string& address,
                                                      const std::string& port, MakeSpeaker make) {
  return listening(address, port, make, true);
}

}  // namespace probe::wire
