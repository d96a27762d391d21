// Work in a process of its own: what it brings back, and each way in which it can end.
#include "runtime/base/apart.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/large.h"

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
        "cannot be read within 1024 MiB of memory" + large_hint());
}

TEST_CASE("what takes too long, too much memory or answers too much is ended") {
  CHECK(failure_of(
            [](const AnswerWriter&) {
              std::atomic<int> count{0};
              while (count != -1) count = count == 1 ? 0 : 1;
              return true;
            },
            {.cpu_s = 1}) == "takes more than 1 s of computing" + large_hint());
  CHECK(failure_of([](const AnswerWriter&) { return ::sleep(100) == 0; }, {.clock_s = 1}) ==
        "takes more than 1 s" + large_hint());
#ifndef __SANITIZE_ADDRESS__
  CHECK(failure_of(
            [](const AnswerWriter& write) {
              std::vector<std::string> all;
              while (all.size() < 10'000) all.emplace_back(std::size_t{1} << 20, 'x');
              return write(all.back());
            },
            {.memory = std::size_t{64} << 20}) ==
        "cannot be read within 64 MiB of memory" + large_hint());
#endif
  CHECK_FALSE(run_apart([](const AnswerWriter& write) { return write(std::string(2 << 20, 'x')); },
                        {.answer = std::size_t{1} << 20})
                  .ok());
  CHECK_FALSE(run_apart([](const AnswerWriter&) -> bool { throw std::runtime_error("x"); }).ok());
}

TEST_CASE("what a process writes piece by piece comes as it is read, and ends with its reader") {
  const std::string large(std::size_t{3} << 20, 'x');
  const auto stream = ApartStream::start([&](const AnswerWriter& write) {
    for (int i = 0; i < 3; ++i) {
      if (!write(large)) return false;
    }
    return true;
  });
  REQUIRE(stream.ok());
  std::string got(large.size(), ' ');
  for (int i = 0; i < 3; ++i) {
    got.assign(large.size(), ' ');
    REQUIRE((*stream)->read(got).ok());
    CHECK(got == large);
  }
  got.resize(1);
  const Status behind = (*stream)->read(got);
  REQUIRE_FALSE(behind.ok());
  CHECK(behind.failure().message == "makes its reader end in the middle");
  CHECK_FALSE((*stream)->read(got).ok());
  // One that nobody reads is ended.
  const auto endless = ApartStream::start([](const AnswerWriter& write) {
    while (write("and so on ")) continue;
    return true;
  });
  REQUIRE(endless.ok());
  CHECK((*endless)->read(got).ok());
}

TEST_CASE("a stream's crash is a failure behind what was written, and its seconds are of a piece") {
  const auto crashing = ApartStream::start(
      [](const AnswerWriter& write) { return write("so far") && ::raise(SIGSEGV) == 0; });
  REQUIRE(crashing.ok());
  std::string got(6, ' ');
  REQUIRE((*crashing)->read(got).ok());
  CHECK(got == "so far");
  const Status crash = (*crashing)->read(got);
  REQUIRE_FALSE(crash.ok());
  CHECK(crash.failure().message == "makes its reader crash (SIGSEGV)");

  const auto compute = [](double seconds) {
    const std::clock_t end =
        std::clock() + static_cast<std::clock_t>(seconds * static_cast<double>(CLOCKS_PER_SEC));
    while (std::clock() < end) continue;
  };
  const auto slow = ApartStream::start(
      [&](const AnswerWriter& write) {
        for (int i = 0; i < 3; ++i) {
          compute(0.7);
          if (!write("x")) return false;
        }
        compute(30);
        return write("y");
      },
      {.cpu_s = 1});
  REQUIRE(slow.ok());
  got.resize(3);
  CHECK((*slow)->read(got).ok());
  const Status late = (*slow)->read(got);
  REQUIRE_FALSE(late.ok());
  CHECK(late.failure().message == "takes more than 1 s of computing" + large_hint());
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
