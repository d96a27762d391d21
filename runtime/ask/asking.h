// The threads of a call of `ask`: some draw looks, others put their queries to the model, one
// folder takes the rows. What is asked, of whom and into which folder was settled before: ask.h.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/ask/bounded_queue.h"
#include "runtime/ask/chat.h"
#include "runtime/ask/prepared.h"

namespace probe::ask {

// One query of a look that is drawn.
struct Ready {
  std::shared_ptr<const PreparedLook> look;
  std::size_t query = 0;
};

// What all threads read, and what they write one at a time.
struct AskingState {
  const plan::Plan& plan;
  const AskOptions& options;
  const ModelTraits& traits;
  const Queries& queries;
  const RecordedRows& recorded;
  std::vector<std::size_t> looks;  // of queries.looks(), that have something left
  std::shared_ptr<const stage::SharedAssets> assets;
  Answers& answers;
  BoundedQueue<Ready>& ready;
  AskSummary& summary;
  const ChatChoice* chat;  // of a server; else null
  policy::QueryMeter& meter;
  std::mutex mutex = {};  // summary, progress and the count below
  int lost_in_a_row = 0;  // queries that a server's failures spoiled for good
  std::atomic<bool> stopped = false;
};

// Draws and asks until all is done, or somebody fails.
Status ask_all(AskingState& shared);

}  // namespace probe::ask
