// What LeRobot's asynchronous inference says (src/lerobot/transport/services.proto and
// async_inference/helpers.py): protobuf messages of one or two fields around pickles of its
// dataclasses.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/grpc.h"
#include "runtime/wire/value.h"

namespace probe::servers::lerobot {

inline constexpr const char* kReady = "/transport.AsyncInference/Ready";
inline constexpr const char* kSendPolicy = "/transport.AsyncInference/SendPolicyInstructions";
inline constexpr const char* kSendObservations = "/transport.AsyncInference/SendObservations";
inline constexpr const char* kGetActions = "/transport.AsyncInference/GetActions";

// RemotePolicyConfig: which policy the server loads, and what an observation holds.
struct PolicySetup {
  std::string type;    // "smolvla"
  std::string model;   // name or path, as the server sees it
  std::string device;  // "cuda"
  int chunk = 1;       // actions of an answer, at most
  wire::Map features;  // by their names, {"dtype", "shape", "names"} each
};

// TimedObservation.
struct Observation {
  double timestamp = 0;
  std::int64_t timestep = 0;
  wire::Map content;    // arrays, numbers and the instruction, by their names
  bool must_go = true;  // also where the state is near the last one's
};

// TimedAction.
struct TimedAction {
  double timestamp = 0;
  std::int64_t timestep = 0;
  wire::Array action;
};

// Calls with their messages; an observation goes in parts of 2 MiB at most, the last of them small,
// so that all others can be sent while the server still works on another.
wire::GrpcCall ready();
wire::GrpcCall get_actions();
wire::GrpcCall send_policy(const PolicySetup& setup);
wire::GrpcCall send_observation(const Observation& observation);

// The message of GetActions; no actions are an empty one.
wire::Bytes actions_message(const std::vector<TimedAction>& actions);

// The other way; nothing in a pickle is run. Fail (kPolicy) naming what came in the place of what.
Result<PolicySetup> setup_of(const wire::GrpcCall& call);
Result<Observation> observation_of(const wire::GrpcCall& call);
Result<std::vector<TimedAction>> actions_of(const wire::Bytes& message, std::size_t most_bytes);

}  // namespace probe::servers::lerobot
