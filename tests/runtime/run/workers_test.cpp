// Threads: every job once, failures told, results independent of who did what. And globs and
// fingerprints.
#include "runtime/run/workers.h"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "runtime/base/glob.h"
#include "runtime/policy/policy.h"
#include "runtime/store/fingerprint.h"

namespace probe::run {
using namespace probe::store;
namespace {

// Stands for an episode: a worker keeps a world between jobs, the result must not show it.
std::vector<std::uint64_t> run_fake(int workers) {
  std::vector<std::uint64_t> results(200);
  const Status done = run_jobs(results.size(), workers, [&]() -> Result<Worker> {
    auto world = std::make_shared<std::uint64_t>(0);
    return Worker([world, &results](std::size_t index) -> Status {
      *world = index;
      policy::Draws draws(*world);
      for (int i = 0; i < 1000; ++i) *world ^= draws.next();
      results[index] = *world;
      return {};
    });
  });
  CHECK(done.ok());
  return results;
}

TEST_CASE("every job runs once, with the same results for any number of workers") {
  const auto one = run_fake(1);
  CHECK(std::set<std::uint64_t>(one.begin(), one.end()).size() == one.size());
  CHECK(run_fake(2) == one);
  CHECK(run_fake(7) == one);
  CHECK(run_jobs(0, 2, []() -> Result<Worker> {
          return Failure{Fault::kInternal, "never made", ""};
        }).ok());
}

TEST_CASE("where the system gives no thread one does all the jobs") {
  const auto expected = run_fake(1);
  const pid_t child = ::fork();
  if (child == 0) {
    // No room for another stack.
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (2 << 20);
    const rlimit limit{most, most};
    ::setrlimit(RLIMIT_AS, &limit);
    ::_exit(run_fake(4) == expected ? 42 : 1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 42);
}

TEST_CASE("the first failure stops the hand-out and is returned") {
  std::atomic<int> done{0};
  const Status status = run_jobs(1000, 2, [&]() -> Result<Worker> {
    return Worker([&](std::size_t index) -> Status {
      if (index == 5) return Failure{Fault::kStore, "disk full", "dir"};
      ++done;
      return {};
    });
  });
  REQUIRE_FALSE(status.ok());
  CHECK(status.failure().message == "disk full");
  CHECK(done < 999);
  const Status unmade = run_jobs(3, 2, []() -> Result<Worker> {
    return Failure{Fault::kPolicy, "no server", ""};
  });
  CHECK(unmade.failure().message == "no server");
}

TEST_CASE("globs match names") {
  CHECK(matches_glob("*", ""));
  CHECK(matches_glob("carrot_*", "carrot_on_plate"));
  CHECK(matches_glob("*_on_*te", "carrot_on_plate"));
  CHECK(matches_glob("c?rrot*plate", "carrot_on_plate"));
  CHECK_FALSE(matches_glob("carrot", "carrot_on_plate"));
  CHECK_FALSE(matches_glob("*spoon", "spoon_on_towel"));
  CHECK(matches_glob(std::string(40, '*') + "x", std::string(2000, 'y') + "x"));
}

TEST_CASE("a fingerprint names program, libraries and CPU, and says what differs") {
  const Fingerprint here = take_fingerprint(sha256(std::string_view("assets")));
  CHECK(here == take_fingerprint(sha256(std::string_view("assets"))));
  for (const char* name : {"program", "compiler", "cpu", "assets", "libm"}) {
    bool found = false;
    for (const auto& [entry, value] : here.entries) found |= entry == name && !value.empty();
    CHECK_MESSAGE(found, name);
  }
  const auto back = fingerprint_from_json(to_json(here));
  REQUIRE(back.ok());
  CHECK(*back == here);
  CHECK(differences(here, here).empty());
  const Fingerprint other{{{"cpu", "b"}, {"program", "x"}}};
  CHECK(differences({{{"cpu", "a"}, {"program", "x"}}}, other) ==
        std::vector<std::string>{"cpu: recorded a, here b"});
  CHECK_FALSE(fingerprint_from_json("[1").ok());
  CHECK_FALSE(fingerprint_from_json(R"({"cpu": 3})").ok());
}

}  // namespace
}  // namespace probe::run
