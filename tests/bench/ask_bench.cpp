// Asking: pictures drawn and encoded, a server that takes 200 ms an answer kept busy, and rows into
// a folder of answers.
#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/ask/picture.h"
#include "runtime/ask/plan_reading.h"
#include "runtime/ask/prepared.h"
#include "runtime/ask/truth.h"
#include "runtime/ask/wording.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/ids.h"
#include "tests/bench/need.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace {

using namespace probe;
using bench::need;

const std::string& assets() {
  static const std::string root = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return root;
}

// The largest that this process was, in MB.
double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) / 1024;
  }
  return 0;
}

// Settled, drawn at 640 x 480 and made a file, by two threads.
void pictures(benchmark::State& state) {
  constexpr std::uint32_t kStarts = 16;
  constexpr int kThreads = 2, kEach = 32;
  const plan::Plan plan = ask::asking_plan(kStarts);
  const std::uint32_t tasks[] = {0};
  const auto shared = need(stage::SharedAssets::load(plan, assets(), tasks));
  const ask::PictureRule rule;
  for (auto _ : state) {
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
      threads.emplace_back([&, thread] {
        ask::Viewer viewer(plan, shared, rule);
        for (std::uint32_t i = 0; i < kEach; ++i) {
          const ask::View view =
              need(viewer.start((i + static_cast<std::uint32_t>(thread)) % kStarts));
          benchmark::DoNotOptimize(need(ask::to_sent(view, rule)).png.size());
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  state.counters["pictures"] = benchmark::Counter(
      static_cast<double>(state.iterations() * kThreads * kEach), benchmark::Counter::kIsRate);
}

// Answers every POST with A, 200 ms after its last byte, as many at a time as are asked.
class SlowChatServer {
 public:
  SlowChatServer() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* name = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_, name, size) != 0 || ::listen(listener_, 256) != 0 ||
        ::getsockname(listener_, name, &size) != 0)
      std::abort();
    port_ = ntohs(address.sin_port);
    accepting_ = std::thread([this] { accept_all(); });
  }
  ~SlowChatServer() {
    ::shutdown(listener_, SHUT_RDWR);
    accepting_.join();
    ::close(listener_);
    for (std::thread& thread : talking_) thread.join();
  }
  std::string model() const {
    return "openai://127.0.0.1:" + std::to_string(port_) + "?model=m&logprobs=off";
  }

 private:
  void accept_all() {
    for (;;) {
      const int peer = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (peer < 0) return;
      const int on = 1;
      ::setsockopt(peer, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      talking_.emplace_back([peer] { talk(peer); });
    }
  }

  static void talk(int peer) {
    std::string got;
    std::vector<char> buffer(1 << 18);
    for (;;) {
      std::size_t end = got.find("\r\n\r\n");
      std::size_t whole = std::string::npos;
      if (end != std::string::npos) {
        const std::size_t at = got.find("Content-Length: ");
        whole = end + 4 + static_cast<std::size_t>(std::atoll(got.c_str() + at + 16));
      }
      if (whole == std::string::npos || got.size() < whole) {
        const ssize_t count = ::recv(peer, buffer.data(), buffer.size(), 0);
        if (count <= 0) break;
        got.append(buffer.data(), static_cast<std::size_t>(count));
        continue;
      }
      got.erase(0, whole);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      const std::string body =
          R"({"model": "m", "choices": [{"message": {"content": "A"}, "finish_reason": "stop"}]})";
      const std::string answer =
          "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n"
          "Content-Length: " +
          std::to_string(body.size()) + "\r\n\r\n" + body;
      if (::send(peer, answer.data(), answer.size(), MSG_NOSIGNAL) < 0) break;
    }
    ::close(peer);
  }

  int listener_;
  int port_ = 0;
  std::thread accepting_;
  std::vector<std::thread> talking_;
};

// One choice with as many options as there are letters: 26 queries a start, as a task of the
// suite's is asked about so many.
void ask_letters(plan::Writer& writer) {
  ask::QuestionWriter q(writer);
  std::vector<ask::WrittenOption> options = {{"carrot", 0, true}, {"plate", 1, true}};
  while (options.size() < 26) options.push_back({"thing " + std::to_string(options.size())});
  q.family("source", plan::QuestionForm::kChoice);
  q.question("Which object must it pick up?", plan::QuestionTruth::kProved, options).right = 0;
}

void slow_server(benchmark::State& state) {
  const SlowChatServer server;
  const plan::Plan plan = ask::asking_plan(64, ask_letters);
  double answers = 0, elapsed = 0, busy = 0, waiting = 0;
  for (auto _ : state) {
    const run::TemporaryFolder folder;
    ask::AskOptions options;
    options.model = server.model();
    options.out = folder / "answers";
    options.jobs = 32;
    options.assets = assets();
    const ask::AskSummary summary = need(ask::ask(plan, options));
    if (summary.invalid > 0) state.SkipWithError("an answer is invalid");
    answers += static_cast<double>(summary.call.answers);
    elapsed += summary.call.elapsed_s;
    busy += summary.call.queries.busy_s;
    waiting += summary.call.queries.waiting_s;
  }
  state.counters["answers_per_s"] = answers / elapsed;
  state.counters["of_160_per_s_percent"] = 100 * answers / elapsed / 160;
  state.counters["busy_percent"] = 100 * busy / elapsed;
  state.counters["questions_at_it"] = waiting / elapsed;
}

constexpr const char* kModel = "m";

// Rows as asking stores them, about the choice (3 orders) and the yes or no of each start in three
// arms; `visit` takes them with the question's place.
template <typename Visit>
void make_rows(const plan::Plan& plan, const Visit& visit) {
  std::vector<ask::AnswerRow> of_start;
  std::vector<std::uint32_t> places;
  for (std::uint32_t q = 0; q < 2; ++q) {
    const plan::QuestionRecord& question = plan.questions()[q];
    const plan::FamilyRecord& family = plan.families()[question.family];
    for (std::uint32_t rotation = 0; rotation < ask::rotations_of(plan, question); ++rotation) {
      ask::AnswerRow row;
      row.model = kModel;
      row.question_id = to_hex(plan::to_sha256(question.question_id));
      row.rotation = rotation;
      row.set = plan.text(family.set);
      row.family = plan.text(family.name);
      row.task = plan.text(plan.tasks()[question.task].name);
      const ask::Wording wording = ask::word(plan, question, rotation, 640, 480);
      row.text = wording.text;
      row.prompt_sha256 = row.image_sha256 = row.request_sha256 = to_hex(sha256(row.text));
      row.raw = q == 0 ? "The answer is B, because of what the robot was told to do with it."
                       : "No, there is none on the table.";
      row.reading =
          ask::read_answer(ask::read_context(plan, question, wording.shown, 640, 480), row.raw);
      const ask::Truth truth = *ask::known_truth(plan, question);
      row.expected = truth.expected;
      row.right = ask::is_right(truth, row.reading);
      of_start.push_back(std::move(row));
      places.push_back(q);
    }
  }
  const auto starts = plan.episodes();
  for (std::uint32_t at = 0; at < starts.size(); ++at) {
    const plan::EpisodeRecord& episode = starts[at];
    const std::uint32_t other = at == 0 ? static_cast<std::uint32_t>(starts.size() - 1) : at - 1;
    for (const ask::Arm arm : {ask::Arm::kPicture, ask::Arm::kBlind, ask::Arm::kPrior}) {
      for (std::size_t i = 0; i < of_start.size(); ++i) {
        ask::AnswerRow& row = of_start[i];
        row.start_id = to_hex(plan::to_sha256(episode.start_id));
        row.episode = static_cast<int>(episode.index);
        row.arm = arm;
        // No picture, the start's own, another start's.
        row.image_sha256 = arm == ask::Arm::kBlind ? "" : row.request_sha256;
        row.shown_start_id.clear();
        row.shown_has_answer.reset();
        if (arm == ask::Arm::kPrior) {
          row.shown_start_id = to_hex(plan::to_sha256(starts[other].start_id));
          row.shown_has_answer = ask::has_answer(plan, plan.questions()[places[i]], other);
        }
        visit(row, places[i]);
      }
    }
  }
}

void rows(benchmark::State& state) {
  const plan::Plan plan = ask::asking_plan(8'334);
  std::int64_t written = 0;
  for (auto _ : state) {
    const run::TemporaryFolder folder;
    const ask::AskRecord record{{to_hex(plan.root()), kModel, "bench"}, "smoke", {}};
    written = 0;
    state.counters["peak_mb_before"] = peak_mb();
    {
      const auto answers = need(ask::Answers::open(folder / "answers", record, plan.bytes()));
      make_rows(plan, [&](const ask::AnswerRow& row, std::uint32_t place) {
        need(answers->commit(row, place));
        ++written;
      });
      need(answers->flush());
    }
    state.counters["peak_mb_written"] = peak_mb();
    std::int64_t count = 0;
    const auto begun = std::chrono::steady_clock::now();
    need(ask::for_each_answer(folder / "answers", [&](ask::AnswerRow row, std::uint32_t) -> Status {
      if (row.invalid) state.SkipWithError(row.invalid->c_str());
      ++count;
      return {};
    }));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    state.counters["read_s"] = took.count();
    if (count != written) state.SkipWithError("not as many rows as were written");
    state.counters["peak_mb_read"] = peak_mb();
  }
  state.counters["rows"] = benchmark::Counter(static_cast<double>(state.iterations() * written),
                                              benchmark::Counter::kIsRate);
}

BENCHMARK(rows)->Name("ask/rows")->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(pictures)->Name("ask/pictures")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(slow_server)
    ->Name("ask/slow_server")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
