// What campaigns share: seeds one by one in a child process, so that one that dies or takes too
// long is a finding and the next goes on behind it; what came of them counted; how long, from the
// words.
//   PROGRAM .. [--for SECONDS | --count N] [--from SEED] [--only SEED]
#pragma once

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace probe::campaign {

// In memory that parent and child share.
struct Tally {
  std::uint64_t seed, end;
  std::array<std::uint64_t, 512> counts;  // of what, the campaign knows
  char found[2000];                       // what must not be, of the seed; empty: nothing

  void find(const std::string& what) { std::snprintf(found, sizeof found, "%s", what.c_str()); }
};

struct Options {
  std::vector<std::string> words;  // beside the options
  double seconds = 0;
  std::uint64_t from = 1, count = 0;
};

[[noreturn]] inline void usage(const std::string& program, const std::string& what) {
  std::fprintf(stderr, "%s: %s\n%s .. [--for SECONDS | --count N] [--from SEED] [--only SEED]\n",
               program.c_str(), what.c_str(), program.c_str());
  std::exit(2);
}

inline Options read_options(const std::string& program, int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("--")) {
      options.words.push_back(word);
      continue;
    }
    if (i + 1 == argc) usage(program, word + " takes a number");
    const char* value = argv[++i];
    if (std::string(value).find_first_not_of("0123456789") != std::string::npos || *value == '\0')
      usage(program, word + " takes a number");
    if (word == "--for") {
      options.seconds = std::strtod(value, nullptr);
    } else if (word == "--count") {
      options.count = std::strtoull(value, nullptr, 10);
    } else if (word == "--from") {
      options.from = std::strtoull(value, nullptr, 10);
    } else if (word == "--only") {
      options.from = std::strtoull(value, nullptr, 10);
      options.count = 1;
    } else {
      usage(program, "knows no " + word);
    }
  }
  return options;
}

struct Limits {
  double seconds = 60;              // of a seed
  rlim_t memory = rlim_t{6} << 30;  // bytes of address space
};

// `attempt` tries the seed of the tally. Prints findings as they come and the last line; the exit
// code. `say` prints what the counts are.
inline int run(const Options& options, const Limits& limits,
               const std::function<void(Tally&)>& attempt,
               const std::function<void(const Tally&)>& say) {
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  void* const memory =
      mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) usage("campaign", "no memory to share");
  auto& tally = *new (memory) Tally{};
  tally.seed = options.from;
  tally.end =
      options.count > 0 ? options.from + options.count : std::numeric_limits<std::uint64_t>::max();
  const double begun = now(), until = options.seconds > 0 ? begun + options.seconds : 1e300;
  int findings = 0;
  while (tally.seed < tally.end && now() < until) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) usage("campaign", "no process to work in");
    if (child == 0) {
      const rlimit limit{limits.memory, limits.memory}, none{0, 0};
      setrlimit(RLIMIT_AS, &limit);
      setrlimit(RLIMIT_CORE, &none);
      for (; tally.seed < tally.end && tally.found[0] == '\0'; ++tally.seed) {
        attempt(tally);
        if (tally.found[0] != '\0') _exit(1);
      }
      _exit(0);
    }
    volatile const std::uint64_t& seed = tally.seed;
    std::uint64_t known = seed;
    double since = now();
    int status = 0;
    std::string why;
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (seed != known) known = seed, since = now();
      const bool is_over = now() >= until;
      if (is_over || now() - since > limits.seconds) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        if (!is_over) why = "took too long";
        status = 0;
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && tally.seed < tally.end && now() < until &&
        why.empty())
      why = "ended the program";
    if (WIFSIGNALED(status)) why = std::string("died of ") + strsignal(WTERMSIG(status));
    if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
      why = tally.found[0] != '\0' ? tally.found
                                   : "ended with " + std::to_string(WEXITSTATUS(status));
    tally.found[0] = '\0';
    if (why.empty()) continue;
    ++findings;
    std::printf("FOUND seed %llu: %s\n", static_cast<unsigned long long>(tally.seed), why.c_str());
    ++tally.seed;
  }
  say(tally);
  std::printf("%llu seeds from %llu on, %.0f s, %d findings\n",
              static_cast<unsigned long long>(tally.seed - options.from),
              static_cast<unsigned long long>(options.from), now() - begun, findings);
  return findings == 0 ? 0 : 1;
}

}  // namespace probe::campaign
