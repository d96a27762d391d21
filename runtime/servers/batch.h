// Batches: the questions of all worlds that wait go to the server in one message, so that one
// forward pass serves them. One connection for a run; a thread of its own sends, so that every
// world waits for its own answer and for no longer than its own time. Of protocols whose servers
// keep nothing between questions: who asks beside whom changes no answer.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/query_meter.h"
#include "runtime/servers/identity.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// The line that the worlds of a run share. Any thread may call any method at any time.
class BatchLine {
 public:
  // `queries` may be null, and outlives this. `identity`, if there is one, is asked of each
  // connection, in the form of `profile`; a batch with room to spare has its first question, too.
  BatchLine(std::unique_ptr<Transport> transport, BatchLimits limits, policy::QueryMeter* queries,
            std::shared_ptr<Identity> identity = nullptr, Profile profile = {});
  ~BatchLine();
  BatchLine(const BatchLine&) = delete;
  BatchLine& operator=(const BatchLine&) = delete;

  // One attempt, unless the connection stands; worlds that come while another tries have its
  // attempt's failure.
  Status open(const Deadlines& deadlines);
  Status adapt(Profile& profile) const;
  std::vector<std::string> notes() const;
  std::vector<std::string> remarks() const;

  // A world that will ask comes, and goes. A batch is sent when it is full, when every world that
  // is here waits in it, or when its first question has waited for `wait`.
  void come();
  void go();

  // Waits for `deadlines.answer` at most, from here on. What fails of one item is its question's
  // alone. The failure of a whole batch is that of each of its questions; the connection is then
  // dropped, and the next batch makes another.
  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines& deadlines);

 private:
  using Clock = std::chrono::steady_clock;
  using Answer = Result<std::vector<RawAction>>;
  struct Question {
    Question(Request asked, const Deadlines& times)
        : request(std::move(asked)),
          deadlines(times),
          since(Clock::now()),
          until(since + times.answer) {}
    Request request;  // its world may be gone before it is answered
    Deadlines deadlines;
    Clock::time_point since, until;
    std::optional<Answer> answer;
  };
  using Questions = std::vector<std::shared_ptr<Question>>;

  void run();
  std::size_t enough() const;  // questions that no other will come to; under mutex_
  Questions take();            // under mutex_
  Result<std::vector<Answer>> send(const Questions& batch);
  Result<std::vector<Answer>> exchange(const Questions& batch);

  Status connect(const Deadlines& deadlines);  // under line_
  Result<std::vector<Answer>> ask_all(std::vector<const Request*> requests,
                                      const Deadlines& deadlines);  // under line_

  BatchLimits limits_;
  policy::QueryMeter* queries_;
  std::shared_ptr<Identity> identity_;
  Profile given_;

  mutable std::mutex line_;  // the two below, and what goes over the wire
  std::unique_ptr<Transport> transport_;
  bool is_open_ = false;
  std::optional<Request> known_;  // identity's first question, as this connection's profile asks it
  Status last_attempt_;
  std::atomic<std::uint64_t> attempts_ = 0;

  std::mutex mutex_;  // all below
  std::condition_variable asked_, answered_;
  std::deque<std::shared_ptr<Question>> waiting_;
  int worlds_ = 0;
  bool is_over_ = false;
  std::thread thread_;
};

// What the worlds of a run find their line in: the first that comes makes it.
class SharedLine {
 public:
  using Make = std::function<Result<std::shared_ptr<BatchLine>>()>;
  Result<std::shared_ptr<BatchLine>> get(const Make& make);

 private:
  std::mutex mutex_;
  std::shared_ptr<BatchLine> line_;
};

// One world's place on the line.
std::unique_ptr<Transport> make_batched(std::shared_ptr<BatchLine> line);

}  // namespace probe::servers
