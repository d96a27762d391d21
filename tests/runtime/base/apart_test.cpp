// Work in a process of its own: what it brings back, and each way in which it can end.
#include "runtime/base/apart.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace probe {
namespace {

std::string failure_of(const std::function<bool(const AnswerWriter&)>& work,
                       const ApartLimits& limits = {}) {
  const auto answer = run_apart(work, limits);
  REQUIRE_FALSE(answer.ok());
  CHECK(answer.failure().code == Fault::kIo);
  return answer.failure().message;
}

// As deep as it is told; a compiler cannot make a loop of it.
int dive(volatile int* depth) {
  volatile char room[4096];
  room[0] = static_cast<char>(*depth);
  if (*depth == 0) return 0;
  *depth = *depth - 1;
  return dive(depth) + room[0];
}

TEST_CASE("what is written apart comes back whole, and nothing else changes") {
  int here = 1;
  const std::string large(std::size_t{20} << 20, 'x');
  const auto answer = run_apart([&](const AnswerWriter& write) {
    here = 2;
    return write("begin ") && write(large);
  });
  REQUIRE_MESSAGE(answer.ok(), (answer ? "" : to_text(answer.failure())));
  CHECK(answer->bytes() == "begin " + large);
  CHECK(here == 1);
  const auto nothing = run_apart([](const AnswerWriter&) { return true; });
  REQUIRE(nothing.ok());
  CHECK(nothing->bytes().empty());
}

TEST_CASE("a crash apart is a failure here that names the signal") {
  CHECK(failure_of([](const AnswerWriter& write) {
          write("half");
          return ::raise(SIGSEGV) == 0;
        }) == "makes its reader crash (SIGSEGV)");
  CHECK(failure_of([](const AnswerWriter&) -> bool { std::abort(); }) ==
        "makes its reader crash (SIGABRT)");
  CHECK(failure_of([](const AnswerWriter&) {
          int depth = 1'000'000;
          return dive(&depth) == 0;
        }).starts_with("makes its reader crash (SIG"));
  CHECK(failure_of([](const AnswerWriter&) -> bool { ::_exit(0); }) ==
        "cannot be read within 2048 MiB of memory");
}

TEST_CASE("what takes too long, too much memory or answers too much is ended") {
  CHECK(failure_of(
            [](const AnswerWriter&) {
              std::atomic<int> count{0};
              while (count != -1) count = count == 1 ? 0 : 1;
              return true;
            },
            {.cpu_s = 1}) == "takes more than 1 s of computing");
  CHECK(failure_of([](const AnswerWriter&) { return ::sleep(100) == 0; }, {.clock_s = 1}) ==
        "takes more than 1 s");
#ifndef __SANITIZE_ADDRESS__
  CHECK(failure_of(
            [](const AnswerWriter& write) {
              std::vector<std::string> all;
              while (all.size() < 10'000) all.emplace_back(std::size_t{1} << 20, 'x');
              return write(all.back());
            },
            {.memory = std::size_t{64} << 20}) == "cannot be read within 64 MiB of memory");
#endif
  CHECK_FALSE(run_apart([](const AnswerWriter& write) { return write(std::string(2 << 20, 'x')); },
                        {.answer = std::size_t{1} << 20})
                  .ok());
  CHECK_FALSE(run_apart([](const AnswerWriter&) -> bool { throw std::runtime_error("x"); }).ok());
}

TEST_CASE("processes are started and waited for while other threads allocate and start their own") {
  std::atomic<bool> stop{false};
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      while (!stop) std::vector<std::string>(100, std::string(100, 'x'));
    });
  }
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 50; ++k) {
        const std::string mine = std::to_string(100 * i + k);
        const auto answer = run_apart([&](const AnswerWriter& write) {
          return write(std::vector<std::string>(10, mine).back());
        });
        good += answer.ok() && answer->bytes() == mine ? 1 : 0;
      }
    });
  }
  threads[2].join();
  threads[3].join();
  stop = true;
  threads[0].join();
  threads[1].join();
  CHECK(good == 100);
}

}  // namespace
}  // namespace probe
