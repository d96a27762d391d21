// What every policy server is asked and answers, whatever it speaks: a Transport turns these into
// its protocol's messages. One small class a protocol; profile, chunks and conversions are
// ServerPolicy's.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"
#include "runtime/servers/profile.h"
#include "runtime/wire/duration.h"
#include "runtime/wire/endpoint.h"
#include "runtime/wire/value.h"

namespace probe::servers {

class SharedModel;

// Questions of one message, at most.
inline constexpr int kMostInBatch = 256;

// How questions of several worlds go together.
struct BatchLimits {
  int most = 8;             // questions of one message
  wire::Duration wait{50};  // that the first of them waits for others
};

// What a server sent and nothing can be done with.
inline Failure bad(std::string message) { return {Fault::kPolicy, std::move(message), ""}; }

struct RequestImage {
  std::string key;
  wire::Array pixels;  // resized and laid out as the profile asks: u8 [h, w, 3] or f32 [3, h, w]
};

struct Request {
  std::string prompt;                // in the profile's form
  std::vector<RequestImage> images;  // in the profile's order, at least one
  std::vector<double> state;         // in the profile's layout, normalised if it asks; may be empty
  // Those of `state.more`, in the profile's order.
  std::vector<std::pair<std::string, std::vector<double>>> more_states = {};
  // As measured, for protocols with a state of their own form.
  policy::Proprioception proprioception;
  int step = 0;                                  // control steps done in the episode
  std::size_t action_size = robot::kActionSize;  // numbers of an action
};

// As the server sent it, for one control step: [dx dy dz, three numbers of rotation, gripper], or a
// number for each joint of the arm and the gripper's.
using RawAction = std::vector<double>;
// What one question is answered: actions for the steps from its own on.
using RawActions = std::vector<RawAction>;
// What the questions of a batch are answered, in their order.
using BatchAnswers = std::vector<Result<RawActions>>;

// The times a Transport is given for one exchange; it must be back when they are over.
struct Deadlines {
  wire::Duration connect{10'000};
  wire::Duration answer{60'000};
};

// How the failure begins that a message which no question has is.
inline constexpr std::string_view kUnasked = "the server sent what nothing asked for";

// A failure (kAnswered) that is an answer: a server is there and says no. ServerPolicy makes
// kPolicy of it.
Failure answered(std::string message);

// Any method that fails (kPolicy or kAnswered, where = the server's HOST:PORT) has left the
// connection in an unknown state: the caller closes and opens again. No message holds a secret.
class Transport {
 public:
  virtual ~Transport() = default;

  // Before open(): what the connections of a run have in common; else each is on its own.
  virtual void share(std::shared_ptr<SharedModel> /*shared*/) {}
  // Before open(): what a server that gathers batches from all its connections is to be told.
  virtual void gather(const BatchLimits& /*limits*/) {}

  // Connects and does what the protocol wants first (metadata, hello, which model). One attempt.
  virtual Status open(const Deadlines& deadlines) = 0;
  // After open(): what the server said it wants, where the profile leaves it open (a picture's
  // size). Fails (kUsage) where the two do not go together.
  virtual Status adapt(Profile& /*profile*/) const { return {}; }
  // Drops the connection, if there is one; returns at once.
  virtual void close() = 0;

  virtual Status begin_episode(const policy::EpisodeStart& /*start*/,
                               const Deadlines& /*deadlines*/) {
    return {};
  }
  // At least one action, each of finite numbers; see to_actions.
  virtual Result<std::vector<RawAction>> ask(const Request& request,
                                             const Deadlines& deadlines) = 0;
  // An answer to each of several requests that go in one message, in their order. Of protocols
  // whose row has batches; there, what a question is answered does not depend on those beside it.
  // One at fault is a failure in its place, naming the item; the connection stands. Fails (kPolicy)
  // as a whole where which answer is whose cannot be said.
  virtual Result<BatchAnswers> ask_all(std::span<const Request* const> requests,
                                       const Deadlines& deadlines);
  // After an episode's last answer, for `wait` at most: fails (kAnswered) where the server sends
  // what nothing asked for, so that answers were out of step with their questions. Of protocols
  // that show it in no other way.
  virtual Status listen(wire::Duration /*wait*/) { return {}; }
  // After an episode whose begin_episode was fine and whose connection still stands. Fails
  // (kAnswered) where something else is answered.
  virtual Status end_episode(const policy::EpisodeEnd& /*end*/, const Deadlines& /*deadlines*/) {
    return {};
  }

  // Sentences for the end of a run: what the server asked for that is not done. After open().
  virtual std::vector<std::string> notes() const { return {}; }
  // What the server said of itself, a line each, for `policy test`; after open().
  virtual std::vector<std::string> remarks() const { return {}; }
};

// Which of a batch's answers a failure is of: "item 3 of 8 of a batch: ...".
Failure of_item(Failure failure, std::size_t index, std::size_t count);
// Fails (kPolicy) unless a batch has an answer a question.
Status check_batch(std::size_t answers, std::size_t questions);

// An answer's numbers as actions of `size`: shapes [size], [n, size], and those with leading
// dimensions of 1. Fails (kPolicy) on other shapes, on nothing, on more than 1000 actions, on
// numbers that are not finite; the message says what was expected and what came.
Result<std::vector<RawAction>> to_actions(const wire::Value& answer,
                                          std::size_t size = robot::kActionSize);

// The end of a text that a server sent, a traceback usually: its last lines on one, without what
// could repaint a terminal, a few hundred characters at most.
std::string last_lines(std::string_view text);

// Fails (kPolicy) where a map in it has a key twice: servers read the last and never see the
// others.
Status check_distinct_keys(const wire::Value& request);

// A state as the array that is sent, of the profile's type.
wire::Array state_array(const Profile& profile, const std::vector<double>& state);

}  // namespace probe::servers
